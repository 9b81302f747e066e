// @ts-check
/**
 * The starts at points of a slice, in units of the well; see `Slice` in `system.js`.
 *
 * @typedef {import("./integrator.js").Integrator} Integrator
 * @typedef {import("./integrator.js").Numbers<"float64">} Floats
 * @typedef {import("./integrator.js").Numbers<"int64">} Integers
 * @typedef {import("./system.js").Slice} Slice
 *
 * A rectangle of a slice, in units of the page.
 *
 * @typedef {object} Window
 * @property {number} xLow
 * @property {number} xHigh
 * @property {number} ordinateLow
 * @property {number} ordinateHigh
 *
 * Starts at n points: states x, y, px, py of shape (4, n), NaN if forbidden, and energies of shape (n,).
 *
 * @typedef {{states: Floats, energies: Floats}} Starts
 *
 * The m starts that are beyond no exit: their indices, states of shape (m, 4), and rows of their energies in the exits.
 *
 * @typedef {{kept: Integers, states: Floats, rows: Integers}} Inside
 */

/**
 * Whether the axes of a slice are x and y.
 *
 * @param {Pick<Slice, "axes">} slice
 */
export const showsPositions = ({axes}) => axes[0] === "x" && axes[1] === "y"

/**
 * Return the axis along which the energy varies: 0 for the horizontal axis, 1 for the vertical axis, −1 for none.
 *
 * @param {Pick<Slice, "axes">} slice
 */
export const energyAxis = ({axes}) => axes.indexOf("h")

/**
 * Whether the starts of a column of a picture have one position and one energy.
 *
 * @param {Pick<Slice, "motion">} slice
 */
export const hasEqualRows = ({motion: [, , along]}) => !along[0] && !along[1] && !along[along.length - 1]

/**
 * Return the edges of a window in units of the well, in the form that kernels take.
 *
 * @param {Integrator} integrator
 * @param {Window} window
 * @param {[number, number]} units  of the axes in units of the page
 */
export function placeWindow(integrator, {xLow, xHigh, ordinateLow, ordinateHigh}, [x, ordinate]) {
  return integrator.array("float64", [4], [xLow / x, xHigh / x, ordinateLow / ordinate, ordinateHigh / ordinate])
}

/**
 * Return the potential and a slice in the form that kernels take.
 *
 * @param {Integrator} integrator
 * @param {Pick<Slice, "axes" | "motion" | "decided">} slice
 * @param {number} energy  of all starts, in units of the well; ignored if the energy is an axis
 * @returns {[number, Floats, Floats, number]}
 */
export function describeSlice(integrator, {axes, motion, decided}, energy) {
  const columns = motion[0].length
  const motionArray = integrator.array("float64", [motion.length, columns], motion.flat())
  // The first row is the origin, whose last coordinate is the energy.
  if (energyAxis({axes}) < 0) motionArray.values[columns - 1] = energy
  return [integrator.address.potential_value, integrator.table, motionArray, decided]
}

/**
 * Return the starts at points of a slice.
 *
 * @param {Integrator} integrator
 * @param {Pick<Slice, "axes" | "motion" | "decided" | "sign">} slice
 * @param {number} energy  of all starts, in units of the well; ignored if the energy is an axis
 * @param {Floats} points  of shape (axes, n), in units of the well
 * @returns {Starts}
 */
export function findStarts(integrator, slice, energy, points) {
  const count = points.shape[1]
  const [states, energies] = [integrator.array("float64", [4, count]), integrator.array("float64", [count])]
  integrator.call("find_starts", ...describeSlice(integrator, slice, energy), slice.sign, points, states, energies)
  return {states, energies}
}

/**
 * Return the starts that are neither forbidden nor beyond an exit.
 *
 * @param {Integrator} integrator
 * @param {Starts} starts
 * @param {import("./exits.js").Exits} exits
 * @param {Integers} rows  row of each energy in the exits
 * @param {import("./integrator.js").Numbers<"int8">} fate  changed in place for the starts that are left out
 * @param {number} [period]  number of starts after which positions and energies repeat; by default they do not
 * @returns {Inside}
 */
export function keepInside(integrator, {states, energies}, exits, rows, fate, period = energies.shape[0]) {
  const count = energies.shape[0]
  const [outside, kept] = [integrator.array("int8", [count]), integrator.array("int64", [count])]
  // In the order of the kernel's parameters.
  const inside = {kept, states: integrator.array("float64", [count, 4]), rows: integrator.array("int64", [count])}
  const [kernel, ...inputs] = integrator.outsideTest
  const [x, y, energy, row, isOutside] = [states.at(0), states.at(1), energies, rows, outside].map(each => each.first(period))
  integrator.call(kernel, ...inputs, x, y, energy, exits.curves, row, isOutside)
  for (let next = period; next < count; next += period) outside.values.copyWithin(next, 0, Math.min(period, count - next))
  const insideCount = integrator.call("select_starts", states, outside, rows, fate, ...Object.values(inside))
  return {kept: kept.first(insideCount), states: inside.states.first(insideCount), rows: inside.rows.first(insideCount)}
}

/** Largest distance between the edges of two windows that are nearly equal, as a share of a side. */
const NEAR_EDGE = 0.02

/**
 * Whether each edge of a window is near the same edge of another window. The margin of a default window is wider.
 *
 * @type {(one: Window, other: Window) => boolean}
 */
export const isNearWindow = (one, other) => {
  const isNearEdge = (/** @type {number} */ a, /** @type {number} */ b, /** @type {number} */ side) =>
    Math.abs(a - b) <= NEAR_EDGE * side
  const [width, height] = [other.xHigh - other.xLow, other.ordinateHigh - other.ordinateLow]
  const nearX = isNearEdge(one.xLow, other.xLow, width) && isNearEdge(one.xHigh, other.xHigh, width)
  return (
    nearX && isNearEdge(one.ordinateLow, other.ordinateLow, height) && isNearEdge(one.ordinateHigh, other.ordinateHigh, height)
  )
}

/**
 * Return the default window of a slice at an energy; null for an energy beyond the table.
 *
 * @param {Integrator} integrator
 * @param {string} plane  name of the slice
 * @param {number} energy  in units of the page
 * @returns {Window | null}
 */
export function windowAt(integrator, plane, energy) {
  const table = integrator.system.windows[plane]
  if (!table) return null
  return integrator.temporarily(() => {
    const energies = integrator.array("float64", [table.energies.length], table.energies)
    const windows = integrator.array("float64", [table.windows.length, 4], table.windows.flat())
    const window = integrator.array("float64", [4])
    if (!integrator.call("interpolate_window", energies, windows, energy, window)) return null
    const [xLow, xHigh, ordinateLow, ordinateHigh] = window.values
    return {xLow, xHigh, ordinateLow, ordinateHigh}
  })
}
