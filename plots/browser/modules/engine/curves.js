// @ts-check
/** The lines over the pictures of a preview: the limiting curve, and the exits, over saddles or at circles. */

import {Exits} from "./exits.js"
import {levelLines, SAMPLES} from "./contours.js"
import {describeSlice, energyAxis, placeWindow} from "./starts.js"

/** Number of points along an exit over a saddle. */
const EXIT_POINTS = 41
/** Number of points along a circle. */
const CIRCLE_POINTS = 121

/** Traces limiting curves. All curves of a window use the same grid of required energies. */
export class LimitingCurves {
  /** @type {import("./contours.js").Grid | null} */
  #grid = null
  #key = ""

  /**
   * Return the limiting curve of a view.
   *
   * @param {import("./integrator.js").Integrator} integrator
   * @param {Pick<import("./pixels.js").View, "slice" | "window" | "energy">} view
   */
  trace(integrator, {slice, window, energy}) {
    const {system} = integrator
    const key = JSON.stringify([system.key, slice, window])
    if (key !== this.#key || !this.#grid) {
      this.#grid = {window, values: requiredEnergies(integrator, slice, window)}
      this.#key = key
    }
    return levelLines(this.#grid, energyAxis(slice) >= 0 ? 0 : energy / system.units.energy)
  }
}

/**
 * Return the lowest energy at which a start exists, at the points of a grid over a window, row by row. On a slice with an axis h,
 * this energy is relative to the h of the point, so the limiting curve is at 0.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./system.js").Slice} slice
 * @param {import("./starts.js").Window} window
 */
const requiredEnergies = (integrator, slice, window) =>
  integrator.temporarily(() => {
    const required = integrator.array("float64", [SAMPLES, SAMPLES])
    const sliceInputs = describeSlice(integrator, slice, 0)
    integrator.call("find_required_energies", ...sliceInputs, placeWindow(integrator, window, slice.units), required)
    return Float64Array.from(required.values)
  })

/**
 * Return the lines of the open exits, with the places of their numbers (NaN for circles), in units of the page.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {number} energy  in units of the page
 * @returns {{channel: number, xs: number[], ys: number[], label: [number, number]}[]}
 */
export function exitLines(integrator, energy) {
  const {units, numberDistance} = integrator.system
  return integrator.temporarily(() => {
    const exits = new Exits(integrator, [energy / units.energy])
    const open = exits.list().filter(({isOpen}) => isOpen)
    return open.map(exit => {
      const count = exit.isCircle ? CIRCLE_POINTS : EXIT_POINTS
      const positions = Array.from({length: count}, (_, i) => (2 * i) / (count - 1) - 1)
      const [xs, ys] = exits.points(exit, positions).map(values => values.map(value => value * units.length))
      const middle = count >> 1
      const distance = exit.isCircle ? NaN : numberDistance
      const label = /** @type {[number, number]} */ ([distance * xs[middle], distance * ys[middle]])
      return {channel: exit.number, xs, ys, label}
    })
  })
}
