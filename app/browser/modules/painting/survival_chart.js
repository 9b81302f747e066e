// @ts-check
/** The chart of the share of an ensemble that is still inside, on a logarithmic axis, with the law of mixed motion. */

import {number} from "../../../../plots/browser/modules/numbers.js"

/** Smallest share on the axis of shares. */
const LEAST_SHARE = 1e-3
/** Margins around the lines, in pixels. */
const [LEFT, RIGHT, TOP, BOTTOM] = [40, 4, 6, 22]
/** Number of straight pieces of which a line consists. */
const PIECES = 240

/**
 * Draw the chart.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{escapeTime: Float64Array, count: number, time: number}} ensemble  times in units of the well
 * @param {{longest: number, unit: number, rate: number, ink: string}} options  `longest`: time at the end of the axis, in units
 *   of the well. `unit`: unit of time of the well, in units of the page. `rate`: decay rate of mixed motion, in units of the
 *   page; 0 if it is not known. `ink`: colour of lines and text
 */
export function drawSurvival(canvas, {escapeTime, count, time}, {longest, unit, rate, ink}) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight]
  const context = canvas.getContext("2d")
  if (!context || !width || !count) return
  const ratio = window.devicePixelRatio
  Object.assign(canvas, {width: width * ratio, height: height * ratio})
  context.setTransform(ratio, 0, 0, ratio, 0, 0)
  const placeX = (/** @type {number} */ t) => LEFT + ((width - LEFT - RIGHT) * t) / longest
  const placeY = (/** @type {number} */ share) =>
    TOP + ((height - TOP - BOTTOM) * Math.log(Math.max(share, LEAST_SHARE))) / Math.log(LEAST_SHARE)
  context.fillStyle = context.strokeStyle = ink
  context.font = "12px system-ui, sans-serif"
  context.globalAlpha = 0.7
  for (const share of [1, 0.1, 0.01, LEAST_SHARE]) {
    context.textAlign = "right"
    context.fillText(String(share), LEFT - 6, placeY(share) + 4)
    context.fillRect(LEFT, placeY(share), width - LEFT - RIGHT, 0.5)
  }
  context.textAlign = "left"
  const law = rate > 0 ? "; dashed: mixed motion" : ""
  context.fillText(`Share inside until t = ${number(longest * unit, 3)}${law}`, LEFT, height - 4, width - LEFT)
  const pastTimes = escapeTime.filter(each => each <= time).sort()
  const drawLine = (/** @type {(t: number) => number} */ shareAt, /** @type {number} */ end) => {
    context.beginPath()
    for (let k = 0; k <= PIECES; k++) {
      const t = (end * k) / PIECES
      const share = shareAt(t)
      if (share < LEAST_SHARE) break
      context.lineTo(placeX(t), placeY(share))
    }
    context.stroke()
  }
  if (rate > 0) {
    context.setLineDash([4, 4])
    drawLine(t => Math.exp(-rate * t * unit), longest)
    context.setLineDash([])
  }
  context.globalAlpha = 1
  context.lineWidth = 2
  drawLine(t => 1 - countUpTo(pastTimes, t) / count, time)
}

/**
 * Return the number of values of an ascending array that are at most a limit.
 *
 * @param {Float64Array} values
 * @param {number} limit
 */
function countUpTo(values, limit) {
  let [low, high] = [0, values.length]
  while (low < high) {
    const middle = (low + high) >> 1
    if (values[middle] <= limit) low = middle + 1
    else high = middle
  }
  return low
}
