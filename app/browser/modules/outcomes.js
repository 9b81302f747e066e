// @ts-check
/** At which exit each orbit of an ensemble will end, found in portions between the frames of the display. */

import {Exits} from "./exits.js"
import {Integrator} from "./integrator.js"
import {propagate} from "./propagate.js"

/** Orbits of a portion. */
const PORTION = 256

export class Outcomes {
  /**
   * @param {import("./system.js").System} system
   * @param {import("./integrator.js").Modules} modules
   * @param {number} energy  in units of the well
   * @param {Float64Array} states  x, y, px, py of each start
   * @param {number} horizon  in units of the well
   */
  constructor(system, modules, energy, states, horizon) {
    const count = states.length / 4
    this.#integrator = new Integrator(system, modules)
    this.#exits = new Exits(this.#integrator, [energy])
    this.#states = states
    this.#horizon = horizon
    /** Number of the exit of each orbit; 0 where it is not known yet, and for those that stay until the horizon. */
    this.channel = new Uint8Array(count)
  }

  #integrator
  #exits
  #states
  #horizon
  #known = 0

  /** Whether all are known. */
  get complete() {
    return this.#known === this.channel.length
  }

  /** Find those of the next portion. */
  continue() {
    const first = this.#known
    this.#known = Math.min(first + PORTION, this.channel.length)
    const states = this.#states.subarray(4 * first, 4 * this.#known)
    const {tolerance} = this.#integrator.system.layout
    const {fate} = propagate(this.#integrator, states, this.#exits, [], this.#horizon, tolerance)
    fate.forEach((code, k) => (this.channel[first + k] = Math.max(code, 0)))
  }
}
