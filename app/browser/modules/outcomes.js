// @ts-check
/** At which exit each orbit of an ensemble will end, found in portions between the frames of the display. */

import {exitCurves} from "./exits.js"
import {Integrator} from "./integrator.js"
import {propagate} from "./propagate.js"

/** Orbits of a portion. */
const PORTION = 256

export class Outcomes {
  /**
   * @param {import("./system.js").System} system
   * @param {WebAssembly.Module} module
   * @param {number} energy  in units of the well
   * @param {Float64Array} states  x, y, px, py of each start
   * @param {number} horizon  in units of the well
   */
  constructor(system, module, energy, states, horizon) {
    const count = states.length / 4
    this.#integrator = new Integrator(system, module)
    this.#exits = exitCurves(system.exits, energy)
    this.#states = states
    this.#horizon = horizon
    this.#fate = new Int8Array(count)
    this.#time = new Float64Array(count)
    this.#crossings = new Uint16Array(count)
    /** Number of the exit of each orbit; 0 where it is not known yet, and for those that stay until the horizon. */
    this.channel = new Uint8Array(count)
  }

  #integrator
  #exits
  #states
  #horizon
  #fate
  #time
  #crossings
  #known = 0

  /** Whether all are known. */
  get complete() {
    return this.#known === this.channel.length
  }

  /** Find those of the next portion. */
  continue() {
    const first = this.#known
    this.#known = Math.min(first + PORTION, this.channel.length)
    const todo = Uint32Array.from({length: this.#known - first}, (_, k) => first + k)
    const exits = this.#exits
    const orbits = {state: this.#states, todo, fate: this.#fate, time: this.#time, crossings: this.#crossings, exits: () => exits}
    propagate(this.#integrator, orbits, this.#horizon, this.#integrator.system.layout.tolerance, exits)
    for (const orbit of todo) this.channel[orbit] = Math.max(this.#fate[orbit], 0)
  }
}
