// @ts-check
/**
 * Exits at one energy, interpolated in the table of a system. In coordinates u outward and q across (90° counterclockwise from
 * u) an exit is the graph u = f(s), s = (q − middle) / halfWidth ∈ [−1, 1], f a Chebyshev series; straight lines continue it
 * beyond its ends. See `engine/taylor/kernels/events.py`.
 *
 * @typedef {object} ExitCurve
 * @property {boolean} open
 * @property {number} gate  beyond this distance along `outward` an orbit may be outside
 * @property {number} reach
 * @property {number} middle
 * @property {number} halfWidth
 * @property {number} slopeLow
 * @property {number} slopeHigh
 * @property {number[]} coefficients
 * @property {[number, number]} origin
 * @property {[number, number]} outward
 */

import {seriesValue} from "./series.js"

/**
 * A channel that no orbit can pass: its gate is out of reach.
 *
 * @type {ExitCurve}
 */
const CLOSED = {
  open: false,
  gate: Infinity,
  reach: 1,
  origin: [0, 0],
  outward: [1, 0],
  middle: 0,
  halfWidth: 1,
  slopeLow: 0,
  slopeHigh: 0,
  coefficients: [0],
}
const MOST_ITERATIONS = 80
/** Escape times are shown as colours and with five digits. */
const ROOT_ACCURACY = 1e-9

/**
 * The exits of all channels at an energy.
 *
 * @param {import("./system.js").ExitTable[]} tables
 * @param {number} energy
 * @returns {ExitCurve[]}
 */
export const exitCurves = (tables, energy) => tables.map(table => exitCurve(table, energy))

/**
 * @param {import("./system.js").ExitTable} table
 * @param {number} energy
 * @returns {ExitCurve}
 */
function exitCurve({saddle, nodes, rows}, energy) {
  if (!(energy > saddle) || nodes.length === 0) return CLOSED
  const row = interpolate(nodes, rows, Math.sqrt(energy - saddle))
  const [gate, reach, originX, originY, outwardX, outwardY, middle, halfWidth, slopeLow, slopeHigh, ...coefficients] = row
  const length = Math.hypot(outwardX, outwardY)
  /** @type {[number, number]} */
  const outward = [outwardX / length, outwardY / length]
  return {open: true, gate, reach, origin: [originX, originY], outward, middle, halfWidth, slopeLow, slopeHigh, coefficients}
}

/**
 * The barycentric formula for Chebyshev nodes of the first kind (Berrut & Trefethen 2004, SIAM Review 46, 501). The second
 * number of a row, the reach, is not smooth: the smaller one of two neighbours is taken.
 *
 * @param {number[]} nodes
 * @param {number[][]} rows
 * @param {number} place
 */
function interpolate(nodes, rows, place) {
  const count = nodes.length
  const sums = rows[0].map(() => 0)
  let total = 0
  for (let k = 0; k < count; k++) {
    if (place === nodes[k]) return rows[k]
    const weight = ((k % 2 ? -1 : 1) * Math.sin((Math.PI * (2 * k + 1)) / (2 * count))) / (place - nodes[k])
    total += weight
    for (let column = 0; column < sums.length; column++) sums[column] += weight * rows[k][column]
  }
  const values = sums.map(sum => sum / total)
  const above = nodes.findIndex(node => node > place)
  const neighbours = above < 0 ? [count - 1] : [above, Math.max(above - 1, 0)]
  values[1] = Math.min(...neighbours.map(k => rows[k][1]))
  return values
}

/**
 * s of a point, −1 and 1 at the ends of the exit.
 *
 * @param {ExitCurve} curve
 * @param {number} x
 * @param {number} y
 */
export function positionAcross({outward, origin, middle, halfWidth}, x, y) {
  return (outward[0] * (y - origin[1]) - outward[1] * (x - origin[0]) - middle) / halfWidth
}

/**
 * Distance of a point from an exit along the channel: positive outside, negative inside.
 *
 * @param {ExitCurve} curve
 * @param {number} x
 * @param {number} y
 */
export function exitDistance(curve, x, y) {
  const {outward, origin} = curve
  const u = outward[0] * (x - origin[0]) + outward[1] * (y - origin[1])
  return u - exitHeight(curve, positionAcross(curve, x, y))
}

/**
 * f(s), by Clenshaw's recurrence.
 *
 * @param {ExitCurve} curve
 * @param {number} position
 */
function exitHeight({coefficients, slopeLow, slopeHigh}, position) {
  const s = Math.min(Math.max(position, -1), 1)
  const beyond = position < -1 ? slopeLow * (position + 1) : position > 1 ? slopeHigh * (position - 1) : 0
  let f = 0
  let last = 0
  for (let k = coefficients.length - 1; k > 0; k--) {
    const next = 2 * s * f - last + coefficients[k]
    last = f
    f = next
  }
  return s * f - last + coefficients[0] + beyond
}

/**
 * The point of an exit at s.
 *
 * @param {ExitCurve} curve
 * @param {number} s
 * @returns {[number, number]}
 */
export function exitPoint(curve, s) {
  const {origin, outward, middle, halfWidth} = curve
  const u = exitHeight(curve, s)
  const q = middle + halfWidth * s
  return [origin[0] + u * outward[0] - q * outward[1], origin[1] + u * outward[1] + q * outward[0]]
}

/**
 * The channel whose exit an orbit crosses outward in a step from (x0, y0) to (x1, y1), 0 for none.
 *
 * @param {ExitCurve[]} curves
 * @param {number} x0
 * @param {number} y0
 * @param {number} x1
 * @param {number} y1
 */
export function crossedExit(curves, x0, y0, x1, y1) {
  for (let k = 0; k < curves.length; k++) {
    const curve = curves[k]
    if (!(curve.outward[0] * x1 + curve.outward[1] * y1 > curve.gate)) continue
    const after = exitDistance(curve, x1, y1)
    if (!(after > 0)) continue
    const before = exitDistance(curve, x0, y0)
    if (before > 0) continue
    const s0 = positionAcross(curve, x0, y0)
    const s1 = positionAcross(curve, x1, y1)
    if (Math.abs(s0 + ((s1 - s0) * before) / (before - after)) <= curve.reach) return k + 1
  }
  return 0
}

/**
 * Time from the start of a step that ends outside to the crossing of the exit, by the Illinois method.
 *
 * @param {ExitCurve} curve
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} duration
 */
export function findExitTime(curve, x, y, lane, duration) {
  const distance = (/** @type {number} */ tau) => exitDistance(curve, seriesValue(x, lane, tau), seriesValue(y, lane, tau))
  let [low, high] = [0, duration]
  let [atLow, atHigh] = [distance(low), distance(high)]
  if (atLow >= 0) return low
  let side = 0
  for (let i = 0; i < MOST_ITERATIONS; i++) {
    const tau = (low * atHigh - high * atLow) / (atHigh - atLow)
    if (!(low < tau && tau < high) || high - low < ROOT_ACCURACY) break
    const value = distance(tau)
    if (Math.abs(value) < ROOT_ACCURACY) return tau
    if (value > 0) {
      high = tau
      atHigh = value
      if (side > 0) atLow *= 0.5
      side = 1
    } else {
      low = tau
      atLow = value
      if (side < 0) atHigh *= 0.5
      side = -1
    }
  }
  return high
}
