// @ts-check
/** Returns of many orbits to the surface of section, in the order of time; see `engine/maps/returns.py`. */

import {Ensemble} from "./ensemble.js"
import {findInside} from "./pixels.js"

/**
 * Time by which all orbits are followed at once, in units of the well. Of returns that follow each other in a shorter time, as to
 * a section that is crossed in both directions, only the last is given.
 */
const STEP = 0.25
/** Longest time, in units of the well: about a hundred periods. */
const LONGEST_TIME = 630

/**
 * What a picture of returns shows: orbits of one energy from a window of a slice, with as many starts along both sides.
 *
 * @typedef {object} Starts
 * @property {import("./system.js").Slice} slice  on the section, whose axes are coordinates
 * @property {number} energy  in units of the page
 * @property {import("./starts.js").Window} window
 * @property {number} side
 * @property {number} duration  longest time of the orbits, in units of the page
 */

export class Returns {
  /**
   * @param {import("./integrator.js").Integrator} integrator  keeps the arrays of the orbits in its memory
   * @param {Starts} starts
   */
  constructor(integrator, {slice, energy, window, side, duration}) {
    const rows = Uint32Array.from({length: side}, (_, row) => row)
    const {inside} = findInside(integrator, {slice, energy, window, columns: side, rows: side}, {rows, columns: side})
    const {units} = integrator.system
    this.#ensemble = new Ensemble(integrator, energy / units.energy, inside.states.values)
    this.#end = Math.min(duration / units.time, LONGEST_TIME)
    this.#columns = slice.sectionColumns ?? []
    this.#units = slice.units
    this.#last = this.#columns.map(column => Float64Array.from(this.#ensemble.atSection(column)))
  }

  #ensemble
  #end
  #columns
  #units
  /** Coordinates of each orbit at its last return that was taken. */
  #last

  /** Whether all orbits have been followed to the longest time. */
  get complete() {
    return this.#ensemble.time >= this.#end
  }

  /**
   * Follow all orbits for a short time, and give each return that they make to a function.
   *
   * @param {(orbit: number, x: number, ordinate: number) => void} take  gets the place on the slice in units of the page
   */
  continue(take) {
    this.#ensemble.advance(Math.min(this.#ensemble.time + STEP, this.#end))
    const [xs, ordinates] = this.#columns.map(column => this.#ensemble.atSection(column))
    const [lastXs, lastOrdinates] = this.#last
    const [unitX, unitOrdinate] = this.#units
    for (let orbit = 0; orbit < this.#ensemble.count; orbit++) {
      if (!(xs[orbit] !== lastXs[orbit] || ordinates[orbit] !== lastOrdinates[orbit]) || Number.isNaN(xs[orbit])) continue
      lastXs[orbit] = xs[orbit]
      lastOrdinates[orbit] = ordinates[orbit]
      take(orbit, xs[orbit] * unitX, ordinates[orbit] * unitOrdinate)
    }
  }
}
