// @ts-check
/** Fates of the starts of a view, some rows at a time. */

import {exitCurves} from "./exits.js"
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
 * @param {import("./interior.js").Interior} interior
 * @param {import("./potential.js").Potential} potential
 * @param {View} view
 * @param {Part} part
 * @returns {Pixels}
 */
export function computePixels(integrator, interior, potential, view, part) {
  const {system} = integrator
  const {fates} = system.layout
  const {slice, window} = view
  const [unitX, unitOrdinate] = slice.units
  const x = pixelCentres(window.xLow / unitX, window.xHigh / unitX, view.columns)
  const ordinate = pixelCentres(window.ordinateLow / unitOrdinate, window.ordinateHigh / unitOrdinate, view.rows)
  const energy = view.energy / energyUnit(system.units)
  const count = part.rows.length * part.columns
  const orbits = {
    state: new Float64Array(4 * count),
    todo: new Uint32Array(count),
    fate: new Int8Array(count).fill(fates.not_computed),
    time: new Float64Array(count).fill(NaN),
    crossings: new Uint16Array(count),
  }
  // The exits of the only energy, or of each along an axis.
  const axis = energyAxis(slice)
  const energies = [x.subarray(0, part.columns), Array.from(part.rows, row => ordinate[row])][axis] ?? [energy]
  const exits = Array.from(energies, each => exitCurves(system.exits, each))
  const places = [
    (/** @type {number} */ orbit) => orbit % part.columns,
    (/** @type {number} */ orbit) => Math.floor(orbit / part.columns),
  ]
  const place = places[axis] ?? (() => 0)
  const exitsOf = (/** @type {number} */ orbit) => exits[place(orbit)]
  const starts = new Starts(slice, potential, energy)
  const {found} = starts
  let todo = 0
  let orbit = 0
  part.rows.forEach(row => {
    for (let column = 0; column < part.columns; column++, orbit++) {
      if (!starts.find(x[column], ordinate[row])) orbits.fate[orbit] = fates.forbidden
      else if (interior.isOutside(exitsOf(orbit), found.h, found.x, found.y)) orbits.fate[orbit] = fates.outside
      else {
        orbits.state[4 * orbit] = found.x
        orbits.state[4 * orbit + 1] = found.y
        orbits.state[4 * orbit + 2] = found.px
        orbits.state[4 * orbit + 3] = found.py
        orbits.todo[todo++] = orbit
      }
    }
  })
  orbits.todo = orbits.todo.subarray(0, todo)
  propagate(integrator, {...orbits, exits: exitsOf}, view.horizon, toleranceFor(system, view), gatesOf(exits))
  return {
    fate: orbits.fate,
    time: Float32Array.from(orbits.time, time => time * system.units.time),
    crossings: orbits.crossings,
  }
}

/**
 * The gate of each channel that is inside its exits at several energies.
 *
 * @param {import("./exits.js").ExitCurve[][]} exits
 */
function gatesOf(exits) {
  return exits[0].map((_, k) =>
    exits.map(curves => curves[k]).reduce((one, other) => (other.gate[2] < one.gate[2] ? other : one)),
  )
}
