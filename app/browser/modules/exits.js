// @ts-check
/**
 * Exits at one energy: over saddles, interpolated in the tables of a system, and circles. In coordinates u outward and q across
 * (90° counterclockwise from u) an exit over a saddle is the graph u = f(s), s = (q − middle) / halfWidth ∈ [−1, 1], f a Chebyshev
 * series; straight lines continue it beyond its ends. A circle has its centre as origin and its radius as half width. See `engine/integrator/kernels/events.py`.
 *
 * @typedef {object} ExitCurve
 * @property {boolean} open
 * @property {-1 | 0 | 1} side  on which side of a circle it is outside: −1 within, 1 beyond; 0 for an exit over a saddle
 * @property {boolean} returns  whether an orbit can pass it and return
 * @property {[number, number, number]} gate  g_x, g_y, g: beyond g_x x + g_y y = g an orbit may be outside; centre and radius of a circle
 * @property {number} reach
 * @property {number} middle
 * @property {number} halfWidth
 * @property {number} slopeLow
 * @property {number} slopeHigh
 * @property {number[]} coefficients
 * @property {[number, number]} origin
 * @property {[number, number]} outward
 */

import {seriesSlope, seriesValue} from "./series.js"

/**
 * A channel that no orbit can pass: its gate is out of reach.
 *
 * @type {ExitCurve}
 */
const CLOSED = {
  open: false,
  side: 0,
  returns: false,
  gate: [1, 0, Infinity],
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
/** Parts of a step that are examined in turn for an orbit that passes an exit and returns. */
const PARTS = 8
/** Escape times are shown as colours and with five digits. */
const ROOT_ACCURACY = 1e-9

/**
 * The exits of all outcomes at an energy.
 *
 * @param {import("./system.js").ExitData[]} exits
 * @param {number} energy
 * @returns {ExitCurve[]}
 */
export const exitCurves = (exits, energy) => exits.map(exit => ("radius" in exit ? circleOf(exit) : exitCurve(exit, energy)))

/** @type {(circle: import("./system.js").Circle) => ExitCurve} */
const circleOf = ({side, x, y, radius}) => ({
  ...CLOSED,
  side,
  returns: true,
  open: true,
  gate: [x, y, radius],
  origin: [x, y],
  halfWidth: radius,
})

/**
 * @param {import("./system.js").ExitTable} table
 * @param {number} energy
 * @returns {ExitCurve}
 */
function exitCurve({shape, saddle, nodes, rows}, energy) {
  if (!(energy > saddle) || nodes.length === 0) return CLOSED
  const row = interpolate(nodes, rows, Math.sqrt(energy - saddle))
  const [gate, reach, originX, originY, outwardX, outwardY, middle, halfWidth, slopeLow, slopeHigh, ...coefficients] = row
  const length = Math.hypot(outwardX, outwardY)
  /** @type {[number, number]} */
  const outward = [outwardX / length, outwardY / length]
  return {
    open: true,
    side: 0,
    returns: shape === "line",
    gate: [outward[0], outward[1], gate],
    reach,
    origin: [originX, originY],
    outward,
    middle,
    halfWidth,
    slopeLow,
    slopeHigh,
    coefficients,
  }
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
 * s of a point, −1 and 1 at the ends of an exit over a saddle.
 *
 * @param {ExitCurve} curve
 * @param {number} x
 * @param {number} y
 */
export function positionAcross({outward, origin, middle, halfWidth}, x, y) {
  return (outward[0] * (y - origin[1]) - outward[1] * (x - origin[0]) - middle) / halfWidth
}

/**
 * Distance of a point from an exit, along the channel or the radius: positive outside, negative inside.
 *
 * @param {ExitCurve} curve
 * @param {number} x
 * @param {number} y
 */
export function exitDistance(curve, x, y) {
  const {outward, origin, side, halfWidth} = curve
  if (side !== 0) return side * (Math.sqrt((x - origin[0]) ** 2 + (y - origin[1]) ** 2) - halfWidth)
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
 * The point of an exit at s; around a circle s goes from −1 to 1.
 *
 * @param {ExitCurve} curve
 * @param {number} s
 * @returns {[number, number]}
 */
export function exitPoint(curve, s) {
  const {origin, outward, middle, halfWidth, side} = curve
  if (side !== 0) return [origin[0] + halfWidth * Math.cos(Math.PI * s), origin[1] + halfWidth * Math.sin(Math.PI * s)]
  const u = exitHeight(curve, s)
  const q = middle + halfWidth * s
  return [origin[0] + u * outward[0] - q * outward[1], origin[1] + u * outward[1] + q * outward[0]]
}

/**
 * The number of the exit that an orbit crosses outward in a step from (x0, y0) to (x1, y1), 0 for none.
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
    if (curve.side === 0 && !(curve.gate[0] * x1 + curve.gate[1] * y1 > curve.gate[2])) continue
    const after = exitDistance(curve, x1, y1)
    if (!(after > 0)) continue
    const before = exitDistance(curve, x0, y0)
    if (before > 0) continue
    if (curve.side !== 0) return k + 1
    const s0 = positionAcross(curve, x0, y0)
    const s1 = positionAcross(curve, x1, y1)
    if (Math.abs(s0 + ((s1 - s0) * before) / (before - after)) <= curve.reach) return k + 1
  }
  return 0
}

/**
 * What has the sign of the time derivative of the distance from a line or a circle.
 *
 * @param {ExitCurve} curve
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} tau
 */
function exitRate(curve, x, y, lane, tau) {
  const {side, origin, outward, coefficients, halfWidth} = curve
  const [vx, vy] = [seriesSlope(x, lane, tau), seriesSlope(y, lane, tau)]
  if (side === 0) {
    const position = positionAcross(curve, seriesValue(x, lane, tau), seriesValue(y, lane, tau))
    const s = Math.min(Math.max(position, -1), 1)
    // The line is a parabola.
    const slope = ((coefficients[1] ?? 0) + 4 * s * (coefficients[2] ?? 0)) / halfWidth
    return outward[0] * vx + outward[1] * vy - slope * (outward[0] * vy - outward[1] * vx)
  }
  return side * ((seriesValue(x, lane, tau) - origin[0]) * vx + (seriesValue(y, lane, tau) - origin[1]) * vy)
}

/**
 * When, within `duration` of the start of a step, an orbit is furthest beyond an exit to which it returns; −1 for never.
 *
 * @param {ExitCurve} curve
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} duration
 */
function findExcursion(curve, x, y, lane, duration) {
  let low = 0
  let rises = exitRate(curve, x, y, lane, low) > 0
  for (let part = 1; part <= PARTS; part++) {
    const high = (duration * part) / PARTS
    const goesOn = exitRate(curve, x, y, lane, high) > 0
    if (rises && !goesOn) {
      const turning = findTurning(curve, x, y, lane, low, high)
      if (isBeyond(curve, seriesValue(x, lane, turning), seriesValue(y, lane, turning))) return turning
    }
    low = high
    rises = goesOn
  }
  return -1
}

/**
 * The last time at which an orbit still goes away from an exit between two times, by bisection.
 *
 * @param {ExitCurve} curve
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} low
 * @param {number} high
 */
function findTurning(curve, x, y, lane, low, high) {
  for (let i = 0; i < MOST_ITERATIONS; i++) {
    const middle = 0.5 * (low + high)
    if (middle <= low || middle >= high) break
    if (exitRate(curve, x, y, lane, middle) > 0) low = middle
    else high = middle
  }
  return low
}

/**
 * Whether a point is beyond an exit, and within the reach of a line.
 *
 * @param {ExitCurve} curve
 * @param {number} x
 * @param {number} y
 */
const isBeyond = (curve, x, y) =>
  exitDistance(curve, x, y) > 0 && (curve.side !== 0 || Math.abs(positionAcross(curve, x, y)) <= curve.reach)

/**
 * The number of the exit that an orbit passes and leaves again within `duration` of the start of a step, 0 for none.
 *
 * @param {ExitCurve[]} curves
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} duration
 */
export const passedExit = (curves, x, y, lane, duration) =>
  curves.findIndex(curve => curve.returns && findExcursion(curve, x, y, lane, duration) >= 0) + 1

/**
 * Time from the start of a step to the crossing of an exit in it, by the Illinois method.
 *
 * @param {ExitCurve} curve
 * @param {import("./series.js").Jet} x
 * @param {import("./series.js").Jet} y
 * @param {number} lane
 * @param {number} duration
 */
export function findExitTime(curve, x, y, lane, duration) {
  const distance = (/** @type {number} */ tau) => exitDistance(curve, seriesValue(x, lane, tau), seriesValue(y, lane, tau))
  const excursion = curve.returns ? findExcursion(curve, x, y, lane, duration) : -1
  let [low, high] = [0, excursion >= 0 ? excursion : duration]
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
