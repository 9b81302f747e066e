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
 * @property {number} most  largest number of returns of an orbit, after which its end is not told
 */

export class Returns {
  /**
   * @param {import("./integrator.js").Integrator} integrator  keeps the arrays of the orbits in its memory
   * @param {Starts} starts
   */
  constructor(integrator, {slice, energy, window, side, duration, most}) {
    const rows = Uint32Array.from({length: side}, (_, row) => row)
    const {inside} = findInside(integrator, {slice, energy, window, columns: side, rows: side}, {rows, columns: side})
    const {units} = integrator.system
    this.#ensemble = new Ensemble(integrator, energy / units.energy, inside.states.values)
    this.#end = Math.min(duration / units.time, LONGEST_TIME)
    const speed = units.length / units.time
    this.#units = [units.length, units.length, speed, speed]
    this.#most = most
    this.#counts = new Uint32Array(this.#ensemble.count)
    this.#last = this.#units.map((_, column) => Float64Array.from(this.#ensemble.atSection(column)))
  }

  #ensemble
  #end
  /** Units of x, y, px and py, in units of the page. */
  #units
  #most
  /** Number of returns of each orbit. */
  #counts
  /** x, y, px and py of each orbit at its last return that was taken. */
  #last
  /** Orbits of which it is known that they have ended. @type {Set<number>} */
  #ended = new Set()

  /** Whether all orbits have been followed to the longest time. */
  get complete() {
    return this.#ensemble.time >= this.#end
  }

  /**
   * Follow all orbits for a short time, and give each return that they make, and each orbit that ends, to a function.
   *
   * @param {(orbit: number, state: number[]) => void} take  gets x, y, px and py, in units of the page
   * @param {(orbit: number, channel: number) => void} [end]  gets the number of the outcome
   */
  continue(take, end = () => {}) {
    this.#ensemble.advance(Math.min(this.#ensemble.time + STEP, this.#end))
    const columns = this.#units.map((_, column) => this.#ensemble.atSection(column))
    for (let orbit = 0; orbit < this.#ensemble.count; orbit++) {
      if (this.#counts[orbit] === this.#most) continue
      const isNew = columns.some((column, k) => column[orbit] !== this.#last[k][orbit])
      if (isNew && !Number.isNaN(columns[0][orbit])) {
        columns.forEach((column, k) => (this.#last[k][orbit] = column[orbit]))
        this.#counts[orbit]++
        take(
          orbit,
          columns.map((column, k) => column[orbit] * this.#units[k]),
        )
      }
      const channel = this.#ensemble.channel[orbit]
      if (channel > 0 && !this.#ended.has(orbit)) {
        this.#ended.add(orbit)
        end(orbit, channel)
      }
    }
  }
}
