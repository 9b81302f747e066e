// @ts-check
/** Outcomes of the starts of a view, computed in parts. */

import {Exits} from "./exits.js"
import {findEnds} from "./orbits.js"
import {energyAxis, findStarts, hasEqualRows, keepInside, placeWindow} from "./starts.js"

/**
 * What a picture shows: a window of a slice at an energy, in units of the page.
 *
 * @typedef {object} View
 * @property {import("./system.js").Slice} slice
 * @property {number} energy
 * @property {import("./starts.js").Window} window
 * @property {number} mostPixels  pixels along a side of the server's map, which a preview does not exceed
 * @property {number} columns
 * @property {number} rows
 * @property {number} horizon  longest time, in units of the well
 *
 * A part of the pixels of a view: the first columns of some rows.
 *
 * @typedef {object} Part
 * @property {Uint32Array} rows  indices of the rows
 * @property {number} columns  number of columns
 *
 * The outcomes of pixels, row by row.
 *
 * @typedef {object} Pixels
 * @property {Int8Array} fate
 * @property {Float32Array} time  of the escape, in units of the page; NaN without an escape
 * @property {Uint16Array} crossings  of the section, until the end of the orbit
 */

/**
 * Integration error of an orbit in a step, in pixels. It can be larger than for an orbit that is followed to t = 1e5. The last
 * coefficients of a step are about as large as the error, in units of the well.
 */
const ERROR_IN_PIXELS = 1e-6
/** Largest norm of the last coefficients of a step, in units of the well. */
const LARGEST_TOLERANCE = 1e-9

/**
 * Return the norm of the last coefficients of a step that suffices for the pixels of a view. An orbit that passes close to a body
 * amplifies errors, and a smaller body amplifies them more.
 *
 * @param {import("./system.js").System} system
 * @param {View} view
 */
function toleranceFor({layout, exits}, {slice, window, columns, rows}) {
  const width = (window.xHigh - window.xLow) / columns / slice.units[0]
  const height = (window.ordinateHigh - window.ordinateLow) / rows / slice.units[1]
  const smallestRadius = Math.min(1, ...exits.flatMap(exit => ("row" in exit && exit.side < 0 ? [exit.radius] : [])))
  const tolerance = Math.min(ERROR_IN_PIXELS * Math.min(width, height), LARGEST_TOLERANCE) * smallestRadius
  return Math.max(tolerance, layout.tolerance)
}

/**
 * Return the pixels of a part of a view.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {View} view
 * @param {Part} part
 * @returns {Pixels}
 */
export const computePixels = (integrator, view, part) => integrator.temporarily(() => computePart(integrator, view, part))

/** @type {typeof computePixels} */
function computePart(integrator, view, part) {
  const {system} = integrator
  const {inside, exits, fate} = findInside(integrator, view, part)
  const ends = findEnds(integrator, inside, exits, {horizon: view.horizon, tolerance: toleranceFor(system, view)}, fate)
  return {...ends, time: Float32Array.from(ends.time, time => time * system.units.time)}
}

/**
 * Find the starts of a part of a view that are inside all exits, and the exits at their energies.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Omit<View, "mostPixels" | "horizon">} view
 * @param {Part} part
 */
export function findInside(integrator, {slice, window, columns, rows, energy}, part) {
  const count = part.rows.length * part.columns
  const [axis, scaledEnergy] = [energyAxis(slice), energy / integrator.system.units.energy]
  const [points, energyRows] = [integrator.array("float64", [2, count]), integrator.array("int64", [count])]
  const grid = [placeWindow(integrator, window, slice.units), columns, rows, integrator.integers(part.rows), part.columns]
  integrator.call("place_pixels", ...grid, axis, points, energyRows)
  const exits = new Exits(integrator, axis < 0 ? [scaledEnergy] : energiesAlong(axis, points.at(axis).values, part))
  const fate = integrator.array("int8", [count])
  // Whether a position is beyond an exit can take longer to find than the orbit.
  const period = hasEqualRows(slice) ? part.columns : count
  const inside = keepInside(integrator, findStarts(integrator, slice, scaledEnergy, points), exits, energyRows, fate, period)
  return {inside, exits, fate}
}

/**
 * Return the energy of each column, or of each row, of a part of a slice with an axis h.
 *
 * @param {number} axis  of the energy
 * @param {Float64Array} energies  of the points, row by row
 * @param {Part} part
 */
function energiesAlong(axis, energies, {rows, columns}) {
  if (axis === 0) return energies.slice(0, columns)
  return Float64Array.from(rows, (_, row) => energies[row * columns])
}
