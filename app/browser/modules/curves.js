// @ts-check
/** The lines over the pictures at an energy of a preview: the limiting curve, and the exits, circles included. */

import {exitCurves, exitPoint} from "./exits.js"
import {sampleGrid, levelLines} from "./contours.js"
import {energyAxis, energyUnit, Starts} from "./slice.js"

/** Points along an exit over a saddle, and along a circle. */
const [EXIT_POINTS, CIRCLE_POINTS] = [41, 121]
/** Place of the number of a channel, as a share of the distance of its exit. */
const LABEL_SHARE = 0.86

/** Traces limiting curves; those of one window need the values of V only once. */
export class LimitingCurves {
  /** @type {import("./contours.js").Grid | null} */
  #grid = null
  #key = ""

  /**
   * @param {import("./system.js").System} system
   * @param {import("./potential.js").Potential} potential
   * @param {Pick<import("./pixels.js").View, "slice" | "window" | "energy">} view
   */
  trace(system, potential, {slice, window, energy}) {
    const key = JSON.stringify([system.key, slice, window])
    if (key !== this.#key || !this.#grid) {
      const starts = new Starts(slice, potential, 0)
      const [unitX, unitOrdinate] = slice.units
      this.#grid = sampleGrid(window, (x, ordinate) => starts.requiredEnergy(x / unitX, ordinate / unitOrdinate))
      this.#key = key
    }
    return levelLines(this.#grid, energyAxis(slice) >= 0 ? 0 : energy / energyUnit(system.units))
  }
}

/**
 * The lines of the open exits in units of the page, with the places of their numbers; NaN for circles.
 *
 * @param {import("./system.js").System} system
 * @param {number} energy  in units of the page
 * @returns {{channel: number, xs: number[], ys: number[], label: [number, number]}[]}
 */
export function exitLines({exits, units}, energy) {
  const lines = exitCurves(exits, energy / energyUnit(units)).map((curve, k) => {
    const count = curve.side === 0 ? EXIT_POINTS : CIRCLE_POINTS
    const points = Array.from({length: count}, (_, i) => exitPoint(curve, (2 * i) / (count - 1) - 1))
    const [xs, ys] = [0, 1].map(axis => points.map(point => point[axis] * units.length))
    const middle = count >> 1
    const share = curve.side === 0 ? LABEL_SHARE : NaN
    const label = /** @type {[number, number]} */ ([share * xs[middle], share * ys[middle]])
    return {channel: k + 1, xs, ys, label, open: curve.open}
  })
  return lines.filter(({open}) => open)
}
