// @ts-check
/**
 * Many orbits at once, and the exits at which they will end. The Taylor series of the present step of each orbit is kept, so that
 * its position at a time within the step is the value of two polynomials; see `engine/integrator/kernels/ensemble.py`.
 */

import {Exits} from "./exits.js"
import {Integrator} from "./integrator.js"
import {findAllEnds} from "./orbits.js"

/** Time for which orbits are followed beyond an exit, except into a body, in units of the well. */
const FOLLOWED_BEYOND = 1.5
/** Number of orbits whose outcomes one call of `Outcomes.continue` finds. */
const PORTION = 256

/** Follows orbits to any time. */
export class Ensemble {
  /**
   * @param {Integrator} integrator  keeps the arrays of the ensemble in its memory
   * @param {number} energy  in units of the well
   * @param {ArrayLike<number>} states  x, y, px, py of each start, in units of the well
   */
  constructor(integrator, energy, states) {
    const count = states.length / 4
    const {rows, order} = integrator.system.layout
    this.#integrator = integrator
    this.#exits = new Exits(integrator, [energy])
    this.#starts = integrator.array("float64", [count, 4], states)
    /** The arrays that kernels change, in the order of the kernels' parameters. */
    this.#arrays = {
      ends: integrator.array("float64", [rows, count]),
      begin: integrator.array("float64", [count]),
      jets: integrator.array("float64", [2, order + 1, count]),
      leaving: integrator.array("int8", [count]),
      escapeTime: integrator.array("float64", [count]),
      last: integrator.array("float64", [count]),
      section: integrator.array("float64", [4, count]),
    }
    this.#positions = integrator.array("float64", [2, count])
    this.#channels = integrator.array("int8", [count])
    this.count = count
    /** The present time, in units of the well. */
    this.time = 0
    this.restart()
  }

  #integrator
  #exits
  #starts
  #arrays
  #positions
  #channels

  /** x of each orbit at the present time, in units of the well; NaN for an orbit far outside. */
  get x() {
    return this.#positions.at(0).values
  }

  /** y of each orbit at the present time, in units of the well. */
  get y() {
    return this.#positions.at(1).values
  }

  /** Number of the exit at which each orbit has ended so far, 0 for an orbit inside. */
  get channel() {
    return this.#channels.values
  }

  /** Time at which each orbit leaves, in units of the well, as far as it is known. */
  get escapeTime() {
    return this.#arrays.escapeTime.values
  }

  /**
   * Return a coordinate of each orbit at its last crossing of the section, in units of the well; NaN before the first crossing.
   *
   * @param {number} column  0 for x, 1 for y, 2 for px, 3 for py
   */
  atSection(column) {
    return this.#arrays.section.at(column).values
  }

  /** Return all orbits to their starts. */
  restart() {
    this.time = 0
    this.#integrator.call("begin_ensemble", this.#starts, ...Object.values(this.#arrays), this.#positions, this.#channels)
  }

  /**
   * Follow all orbits to a time, in units of the well, from their starts if the time is before the present time.
   *
   * @param {number} time
   */
  advance(time) {
    if (time < this.time) this.restart()
    const {address, table, system} = this.#integrator
    const [step, jets, {tolerance}] = [address.step, address.jets, system.layout]
    const exits = [this.#exits.gates, this.#exits.curves.at(0)]
    const arrays = Object.values(this.#arrays)
    this.#integrator.call("advance_ensemble", step, jets, table, tolerance, time, FOLLOWED_BEYOND, ...exits, ...arrays)
    this.time = time
    // At time 0, no orbit has a step yet.
    if (time > 0) this.#integrator.call("place_ensemble", time, ...arrays, this.#positions, this.#channels)
  }

  /** Return the ratio of the spread of the orbits that are still inside to the spread of their starts. */
  growth() {
    return this.#integrator.call("measure_spread", this.#starts, this.#positions, this.#channels)
  }

  /** Return the states x, y, px, py of the orbits that are still inside after the first step, with reversed momenta. */
  reversedStates() {
    return this.#integrator.temporarily(() => {
      const states = this.#integrator.array("float64", [this.count, 4])
      const arrays = Object.values(this.#arrays)
      const count = this.#integrator.call("reverse_ensemble", this.time, ...arrays, this.#channels, states)
      return Float64Array.from(states.first(count).values)
    })
  }
}

/** Finds the exits at which the orbits of an ensemble will end, in portions between the frames of the display. */
export class Outcomes {
  /**
   * @param {import("./system.js").System} system
   * @param {import("./integrator.js").Modules} modules
   * @param {number} energy  in units of the well
   * @param {Float64Array} states  x, y, px, py of each start
   * @param {number} horizon  in units of the well
   */
  constructor(system, modules, energy, states, horizon) {
    this.#integrator = new Integrator(system, modules)
    this.#exits = new Exits(this.#integrator, [energy])
    this.#states = states
    this.#horizon = horizon
    /** Number of the exit at which each orbit ends; 0 if not known yet, or if the orbit stays until the horizon. */
    this.channel = new Uint8Array(states.length / 4)
  }

  #integrator
  #exits
  #states
  #horizon
  #knownCount = 0

  /** Whether all outcomes are known. */
  get complete() {
    return this.#knownCount === this.channel.length
  }

  /** Find the outcomes of the next portion. */
  continue() {
    const first = this.#knownCount
    this.#knownCount = Math.min(first + PORTION, this.channel.length)
    const states = this.#states.subarray(4 * first, 4 * this.#knownCount)
    const {tolerance} = this.#integrator.system.layout
    const {fate} = findAllEnds(this.#integrator, states, this.#exits, {horizon: this.#horizon, tolerance})
    this.channel.set(
      fate.map(code => Math.max(code, 0)),
      first,
    )
  }
}
