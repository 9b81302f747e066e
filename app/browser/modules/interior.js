// @ts-check
/**
 * Which starts lie inside the exits: connected to the origin below the energy without crossing an exit. The path downhill from
 * the point is that of `engine/integrator/kernels/interior.py`. With an escape circle all points within it lie inside; discs around
 * centres belong to no interior.
 */

import {exitDistance, positionAcross} from "./exits.js"

// Lengths and energies are in units of the well. At the shortest step the path has reached a minimum.
const [LONGEST_STEP, SHORTEST_STEP] = [1 / 32, 1e-6]
const MOST_STEPS = 10_000
// Far from the exits steps grow with the distance, by this factor.
const FAR_SHARE = 0.25
// The path descends at this angle to the gradient, so that it leaves symmetry lines, which can end at saddles.
const [COS, SIN] = [Math.cos(0.1), Math.sin(0.1)]
// Smallest decrease of V in a step, relative to that along the gradient.
const DECREASE = 0.25
// Lines to the origin stay below the energy by this, so that they do not pass over a saddle of the same energy.
const ENERGY_MARGIN = 1e-12
// Largest slope at a critical point.
const NO_SLOPE = 1e-9

export class Interior {
  /** @param {import("./potential.js").Potential} potential */
  constructor(potential) {
    this.#potential = potential
    this.#bottom = potential.bottom
  }

  #potential
  #bottom

  /**
   * Whether a point is beyond an exit; false in the forbidden region.
   *
   * @param {import("./exits.js").ExitCurve[]} curves
   * @param {number} energy
   * @param {number} x
   * @param {number} y
   */
  isOutside(curves, energy, x, y) {
    if (curves.some(curve => curve.side !== 0 && exitDistance(curve, x, y) > 0)) return true
    return !curves.some(({side}) => side > 0) && this.#leadsOutside(curves, energy, x, y)
  }

  /**
   * Whether the path downhill from a point ends outside.
   *
   * @param {import("./exits.js").ExitCurve[]} curves
   * @param {number} energy
   * @param {number} x
   * @param {number} y
   */
  #leadsOutside(curves, energy, x, y) {
    const potential = this.#potential
    const level = energy - ENERGY_MARGIN
    let odd = false
    let step = LONGEST_STEP
    for (let i = 0; i < MOST_STEPS; i++) {
      const value = potential.expand(x, y)
      const {slopeX, slopeY} = potential
      const slope = Math.hypot(slopeX, slopeY)
      if (value < this.#bottom) break
      // A saddle of this energy belongs to the well.
      if (slope < NO_SLOPE && value >= level) return false
      if (potential.staysBelow(level)) return odd !== crossesExits(curves, x, y, 0, 0)
      const directionX = -(COS * slopeX - SIN * slopeY) / slope
      const directionY = -(SIN * slopeX + COS * slopeY) / slope
      step = Math.min(2 * step, LONGEST_STEP * Math.max(1, FAR_SHARE * (Math.abs(x) + Math.abs(y))))
      while (step > SHORTEST_STEP) {
        if (potential.value(x + step * directionX, y + step * directionY) < value - DECREASE * step * slope) break
        step *= 0.5
      }
      if (step <= SHORTEST_STEP) break
      const [nextX, nextY] = [x + step * directionX, y + step * directionY]
      if (crossesExits(curves, x, y, nextX, nextY)) odd = !odd
      ;[x, y] = [nextX, nextY]
    }
    return !odd
  }
}

/**
 * Whether a line crosses the open exits over saddles an odd number of times.
 *
 * @param {import("./exits.js").ExitCurve[]} curves
 * @param {number} x0
 * @param {number} y0
 * @param {number} x1
 * @param {number} y1
 */
function crossesExits(curves, x0, y0, x1, y1) {
  let odd = false
  for (const curve of curves) {
    if (!curve.open || curve.side !== 0) continue
    const s0 = positionAcross(curve, x0, y0)
    const s1 = positionAcross(curve, x1, y1)
    // The part of the line with −1 ≤ s ≤ 1.
    let low = 0
    let high = 1
    if (s0 !== s1) {
      const one = (-1 - s0) / (s1 - s0)
      const other = (1 - s0) / (s1 - s0)
      low = Math.max(low, Math.min(one, other))
      high = Math.min(high, Math.max(one, other))
    } else if (Math.abs(s0) > 1) continue
    if (low >= high) continue
    const atLow = exitDistance(curve, (1 - low) * x0 + low * x1, (1 - low) * y0 + low * y1)
    const atHigh = exitDistance(curve, (1 - high) * x0 + high * x1, (1 - high) * y0 + high * y1)
    if (atLow > 0 !== atHigh > 0) odd = !odd
  }
  return odd
}
