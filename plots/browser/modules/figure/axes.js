// @ts-check
/** Axes around a picture on a canvas: a frame, ticks and labels. */

import {number} from "../numbers.js"

/** Space around the frame for ticks and labels, in pixels. */
export const MARGINS = {left: 62, right: 12, top: 8, bottom: 44}
/** Largest number of ticks on an axis, and of pixels per tick. */
const MOST_TICKS = 7
const PIXELS_PER_TICK = 60
/** Length of a tick, and distances of labels from the frame, in pixels. */
const TICK = 5
const LABEL_GAP = 8
/** Digits of a label. */
const LEAST_DIGITS = 4
const MOST_DIGITS = 15

/**
 * Return the multiples of 1, 2 or 5 times a power of ten between two numbers, and their distance.
 *
 * @param {number} low
 * @param {number} high
 * @param {number} most  largest number of multiples
 */
export function ticks(low, high, most) {
  const least = (high - low) / Math.max(most, 1)
  const power = 10 ** Math.floor(Math.log10(least))
  const step = power * ([1, 2, 5].find(factor => factor * power >= least) ?? 10)
  const first = Math.ceil(low / step)
  const values = Array.from({length: Math.max(Math.floor(high / step) - first + 1, 0)}, (_, k) => (first + k) * step)
  return {values, step}
}

/**
 * Return the label of a tick, with enough digits to tell neighbouring ticks apart.
 *
 * @param {number} value
 * @param {number} step  distance of the ticks
 */
export function tickLabel(value, step) {
  // A tick at 0 differs from 0 by rounding.
  if (Math.abs(value) < step / 2) return "0"
  const digits = Math.ceil(Math.log10(Math.abs(value) / step)) + 2
  return number(value, Math.min(Math.max(digits, LEAST_DIGITS), MOST_DIGITS))
}

/**
 * Draw the frame, ticks and labels around a box.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {{left: number, top: number, width: number, height: number}} box  of the frame
 * @param {import("../engine/starts.js").Window} window
 * @param {[string, string]} labels  of the axes
 * @param {string} ink
 */
export function drawAxes(context, {left, top, width, height}, {xLow, xHigh, ordinateLow, ordinateHigh}, labels, ink) {
  context.strokeStyle = context.fillStyle = ink
  context.lineWidth = 1
  context.font = "12px system-ui, sans-serif"
  context.strokeRect(left - 0.5, top - 0.5, width + 1, height + 1)
  const bottom = top + height
  const most = (/** @type {number} */ length) => Math.min(MOST_TICKS, Math.floor(length / PIXELS_PER_TICK))
  const horizontal = ticks(xLow, xHigh, most(width))
  const vertical = ticks(ordinateLow, ordinateHigh, most(height))
  context.beginPath()
  context.textAlign = "center"
  context.textBaseline = "top"
  for (const value of horizontal.values) {
    const x = left + ((value - xLow) / (xHigh - xLow)) * width
    context.moveTo(x, bottom)
    context.lineTo(x, bottom + TICK)
    context.fillText(tickLabel(value, horizontal.step), x, bottom + LABEL_GAP)
  }
  context.textAlign = "right"
  context.textBaseline = "middle"
  for (const value of vertical.values) {
    const y = bottom - ((value - ordinateLow) / (ordinateHigh - ordinateLow)) * height
    context.moveTo(left, y)
    context.lineTo(left - TICK, y)
    context.fillText(tickLabel(value, vertical.step), left - LABEL_GAP, y)
  }
  context.stroke()
  context.textAlign = "center"
  context.textBaseline = "bottom"
  context.fillText(labels[0], left + width / 2, bottom + MARGINS.bottom - 2)
  context.save()
  context.translate(2, top + height / 2)
  context.rotate(-Math.PI / 2)
  context.textBaseline = "top"
  context.fillText(labels[1], 0, 0)
  context.restore()
}
