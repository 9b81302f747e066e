// @ts-check
/**
 * Many orbits at the same time. Each keeps the series of its present step, so that its place at any time within the step costs two
 * polynomials; see `engine/integrator/kernels/ensemble.py`.
 */

import {Exits} from "./exits.js"
import {evaluateSeries} from "./series.js"

/** Orbits are followed for this long beyond an exit that is no disc, in units of the well. */
export const FOLLOWED_BEYOND = 1.5

export class Ensemble {
  /**
   * @param {import("./integrator.js").Integrator} integrator  whose memory the ensemble keeps
   * @param {number} energy  in units of the well
   * @param {Float64Array} states  x, y, px, py of each start, in units of the well
   */
  constructor(integrator, energy, states) {
    const count = states.length / 4
    const {rows, order} = integrator.system.layout
    this.#integrator = integrator
    this.#exits = new Exits(integrator, [energy])
    this.#starts = states
    /** In the order of the kernel. */
    this.#arrays = {
      ends: integrator.array("float64", [rows, count]),
      begin: integrator.array("float64", [count]),
      jets: integrator.array("float64", [2, order + 1, count]),
      leaving: integrator.array("int8", [count]),
      escapeTime: integrator.array("float64", [count]),
      last: integrator.array("float64", [count]),
      section: integrator.array("float64", [2, count]),
    }
    this.#places = integrator.array("float64", [2, count])
    this.#channels = integrator.array("int8", [count])
    this.count = count
    /** In units of the well. */
    this.time = 0
    this.restart()
  }

  #integrator
  #exits
  #starts
  #arrays
  #places
  #channels

  /** Places at the present time; NaN for orbits that are far outside. */
  get x() {
    return this.#places.at(0).values
  }

  get y() {
    return this.#places.at(1).values
  }

  /** Number of the exit at which each orbit has ended so far, 0 for orbits inside. */
  get channel() {
    return this.#channels.values
  }

  /** When each orbit leaves, as far as it is known. */
  get escapeTime() {
    return this.#arrays.escapeTime.values
  }

  /** x of the last upward crossing of y = 0; NaN before the first one. */
  get sectionX() {
    return this.#arrays.section.at(0).values
  }

  /** px there. */
  get sectionPx() {
    return this.#arrays.section.at(1).values
  }

  /** Put all orbits back to their starts. */
  restart() {
    const {ends, begin, leaving, escapeTime, last, section} = this.#arrays
    this.time = 0
    for (const array of [ends, begin, leaving, this.#channels]) array.values.fill(0)
    for (const array of [escapeTime, last]) array.values.fill(Infinity)
    section.values.fill(NaN)
    const [places, states] = [this.#places.values, ends.values]
    for (let i = 0; i < this.count; i++) {
      for (let row = 0; row < 4; row++) states[row * this.count + i] = this.#starts[4 * i + row]
      for (let row = 0; row < 2; row++) places[row * this.count + i] = this.#starts[4 * i + row]
    }
  }

  /**
   * Follow all orbits to a time, in units of the well; an earlier one than the present begins at the starts again.
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
    // Orbits that have not begun are at their starts.
    if (time > 0) this.#integrator.call("place_ensemble", time, ...arrays, this.#places, this.#channels)
  }

  /** How many times as wide as at their starts the orbits are spread that are still inside. */
  growth() {
    const {channel} = this
    const inside = [...channel.keys()].filter(i => channel[i] === 0)
    const [starts, x, y] = [this.#starts, this.x, this.y]
    const before = width(inside, i => starts[4 * i]) ** 2 + width(inside, i => starts[4 * i + 1]) ** 2
    const now = width(inside, i => x[i]) ** 2 + width(inside, i => y[i]) ** 2
    return Math.sqrt(now / before)
  }

  /** Momenta at the present time, which is after the first step; those of orbits that have left mean nothing. */
  momenta() {
    const {begin, jets} = this.#arrays
    const times = Array.from(begin.values, each => this.time - each)
    const [, , px, py] = evaluateSeries(this.#integrator, jets, [...times.keys()], times)
    return {px, py}
  }
}

/**
 * Standard deviation of a number of some orbits.
 *
 * @param {number[]} orbits
 * @param {(orbit: number) => number} value
 */
function width(orbits, value) {
  let [sum, squares] = [0, 0]
  // Relative to the first one: those of a small disc differ in their last digits only.
  const origin = orbits.length ? value(orbits[0]) : 0
  for (const orbit of orbits) {
    const difference = value(orbit) - origin
    sum += difference
    squares += difference * difference
  }
  return Math.sqrt(Math.max(squares / orbits.length - (sum / orbits.length) ** 2, 0))
}
