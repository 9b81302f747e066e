// @ts-check
/** Fates of the starts of a view, some rows at a time. */

import {Exits} from "./exits.js"
import {OutsideTest} from "./interior.js"
import {propagate} from "./propagate.js"
import {energyAxis, energyUnit, pixelCentres, Starts} from "./slice.js"

/**
 * What a picture shows: a part of a slice at an energy, in units of the page.
 *
 * @typedef {object} View
 * @property {import("./system.js").Slice} slice
 * @property {number} energy
 * @property {import("./slice.js").Window} window
 * @property {number} most  pixels along a side of the server's map, which a preview does not exceed
 * @property {number} columns
 * @property {number} rows
 * @property {number} horizon  longest time, in units of the well
 *
 * The pixels of a view in some rows and in the first columns of these.
 *
 * @typedef {object} Part
 * @property {Uint32Array} rows
 * @property {number} columns
 *
 * @typedef {object} Pixels
 * @property {Int8Array} fate
 * @property {Float32Array} time  of the escape, in units of the page; NaN for others
 * @property {Uint16Array} crossings
 */

/**
 * Error of an orbit's integration in pixels: a preview needs no steps as short as those of an orbit that is followed to t = 1e5.
 * The last coefficients of a step are about its error in units of the well.
 */
const ERROR_IN_PIXELS = 1e-6
const LARGEST_TOLERANCE = 1e-9

/**
 * Norm of the last coefficients of a step, small enough for the pixels of a view. An orbit that passes close to a body magnifies
 * errors, the more so the smaller the body.
 *
 * @param {import("./system.js").System} system
 * @param {View} view
 */
export function toleranceFor({layout, exits}, {slice, window, columns, rows}) {
  const width = (window.xHigh - window.xLow) / columns / slice.units[0]
  const height = (window.ordinateHigh - window.ordinateLow) / rows / slice.units[1]
  const smallest = Math.min(1, ...exits.flatMap(exit => ("radius" in exit && exit.side < 0 ? [exit.radius] : [])))
  const tolerance = Math.min(ERROR_IN_PIXELS * Math.min(width, height), LARGEST_TOLERANCE) * smallest
  return Math.max(tolerance, layout.tolerance)
}

/**
 * @param {import("./integrator.js").Integrator} integrator
 * @param {View} view
 * @param {Part} part
 * @returns {Pixels}
 */
export function computePixels(integrator, view, part) {
  return integrator.temporarily(() => {
    const {system} = integrator
    const {fates} = system.layout
    const placed = placeStarts(integrator, view, part)
    const fate = new Int8Array(part.rows.length * part.columns).fill(fates.forbidden)
    const time = new Float32Array(fate.length).fill(NaN)
    const crossings = new Uint16Array(fate.length)
    const exits = new Exits(integrator, placed.exitEnergies)
    const test = new OutsideTest(integrator, exits, placed.energies.length)
    const outside = test.find(placed.states, placed.energies, placed.rows)
    const {pixels, states, rows} = keepInside(placed, outside)
    placed.pixels.forEach(pixel => (fate[pixel] = fates.outside))
    const ends = propagate(integrator, states, exits, rows, view.horizon, toleranceFor(system, view))
    pixels.forEach((pixel, orbit) => {
      fate[pixel] = ends.fate[orbit]
      time[pixel] = ends.time[orbit] * system.units.time
      crossings[pixel] = ends.crossings[orbit]
    })
    return {fate, time, crossings}
  })
}

/**
 * Starts of some pixels.
 *
 * @typedef {object} Placed
 * @property {Uint32Array} pixels
 * @property {Float64Array} states  x, y, px, py of each
 * @property {Float64Array} energies
 * @property {Uint32Array} rows  of the energies in the exits
 */

/**
 * The starts of a part that are not forbidden, and the energies of the exits: the only one, or each along an axis.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {View} view
 * @param {Part} part
 * @returns {Placed & {exitEnergies: ArrayLike<number>}}
 */
function placeStarts(integrator, {slice, window, energy, columns, rows}, part) {
  const [unitX, unitOrdinate] = slice.units
  const x = pixelCentres(window.xLow / unitX, window.xHigh / unitX, columns)
  const ordinate = pixelCentres(window.ordinateLow / unitOrdinate, window.ordinateHigh / unitOrdinate, rows)
  const common = energy / energyUnit(integrator.system.units)
  const axis = energyAxis(slice)
  const exitEnergies = [x.subarray(0, part.columns), Array.from(part.rows, row => ordinate[row])][axis] ?? [common]
  const starts = new Starts(slice, integrator, common)
  const {found} = starts
  const most = part.rows.length * part.columns
  const placed = makePlaced(most)
  let count = 0
  part.rows.forEach((row, place) => {
    for (let column = 0; column < part.columns; column++) {
      if (!starts.find(x[column], ordinate[row])) continue
      placed.pixels[count] = place * part.columns + column
      placed.energies[count] = found.h
      placed.rows[count] = [column, place][axis] ?? 0
      placed.states[4 * count] = found.x
      placed.states[4 * count + 1] = found.y
      placed.states[4 * count + 2] = found.px
      placed.states[4 * count + 3] = found.py
      count++
    }
  })
  return {...first(placed, count), exitEnergies}
}

/** @type {(count: number) => Placed} */
const makePlaced = count => ({
  pixels: new Uint32Array(count),
  states: new Float64Array(4 * count),
  energies: new Float64Array(count),
  rows: new Uint32Array(count),
})

/** @type {(placed: Placed, count: number) => Placed} */
const first = ({pixels, states, energies, rows}, count) => ({
  pixels: pixels.subarray(0, count),
  states: states.subarray(0, 4 * count),
  energies: energies.subarray(0, count),
  rows: rows.subarray(0, count),
})

/**
 * The starts that lie beyond no exit.
 *
 * @param {Placed} placed
 * @param {Int8Array} outside
 * @returns {Placed}
 */
function keepInside(placed, outside) {
  const inside = makePlaced(outside.length)
  let count = 0
  outside.forEach((exit, start) => {
    if (exit > 0) return
    inside.pixels[count] = placed.pixels[start]
    inside.states.set(placed.states.subarray(4 * start, 4 * start + 4), 4 * count)
    inside.energies[count] = placed.energies[start]
    inside.rows[count] = placed.rows[start]
    count++
  })
  return first(inside, count)
}
