// @ts-check
/**
 * Events of y = 0 within a step, as `engine/integrator/kernels/events.py` has them. The coefficients of lane i of a series are
 * `jet[first + k * stride + i]`.
 *
 * @typedef {object} Jet
 * @property {Float64Array} jet
 * @property {number} first
 * @property {number} stride
 * @property {number} order
 */

/** Parts of a step that are examined in turn; within one, ẏ is taken to change its sign at most once. */
const PARTS = 8
const MOST_ITERATIONS = 80

/**
 * A series at time tau after the start of its step.
 *
 * @param {Jet} series
 * @param {number} lane
 * @param {number} tau
 */
export function seriesValue({jet, first, stride, order}, lane, tau) {
  let place = first + order * stride + lane
  let value = jet[place]
  for (let k = order; k > 0; k--) {
    place -= stride
    value = value * tau + jet[place]
  }
  return value
}

/**
 * The time derivative of a series at time tau after the start of its step.
 *
 * @param {Jet} series
 * @param {number} lane
 * @param {number} tau
 */
export function seriesSlope({jet, first, stride, order}, lane, tau) {
  let place = first + order * stride + lane
  let slope = order * jet[place]
  for (let k = order - 1; k > 0; k--) {
    place -= stride
    slope = slope * tau + k * jet[place]
  }
  return slope
}

/**
 * The time between two times at which the slope of a series changes its sign, by bisection.
 *
 * @param {Jet} series
 * @param {number} lane
 * @param {number} low
 * @param {number} high
 */
function findExtremum(series, lane, low, high) {
  const rising = seriesSlope(series, lane, low) > 0
  for (let i = 0; i < MOST_ITERATIONS; i++) {
    const middle = 0.5 * (low + high)
    if (middle <= low || middle >= high) break
    if (seriesSlope(series, lane, middle) > 0 === rising) low = middle
    else high = middle
  }
  return 0.5 * (low + high)
}

/**
 * Number of times y goes from y < 0 to y ≥ 0 within `duration` of the start of a step, pairs of zeros included.
 *
 * @param {Jet} y
 * @param {number} lane
 * @param {number} duration
 */
export function countUpwardCrossings(y, lane, duration) {
  let count = 0
  let low = 0
  let yLow = seriesValue(y, lane, low)
  let slopeLow = seriesSlope(y, lane, low)
  for (let part = 1; part <= PARTS; part++) {
    const high = (duration * part) / PARTS
    const yHigh = seriesValue(y, lane, high)
    const slopeHigh = seriesSlope(y, lane, high)
    // An orbit that starts on y = 0 downward is below from then on.
    const below = yLow < 0 || (yLow === 0 && slopeLow < 0)
    if (below && yHigh >= 0) count++
    else if (yLow * yHigh > 0 && yLow * slopeLow < 0 && yHigh * slopeHigh > 0) {
      const turning = seriesValue(y, lane, findExtremum(y, lane, low, high))
      if (turning < 0 !== yLow < 0) count++
    }
    low = high
    yLow = yHigh
    slopeLow = slopeHigh
  }
  return count
}
