// @ts-check
/**
 * The picture on a slider: the shares of the outcomes at values along the slider, stacked.
 *
 * @typedef {[colour: string, count: number][]} Stack  colours of the outcomes, from the top, and their numbers of pixels
 */

import {contextFor} from "../../../../plots/browser/modules/painting/canvas.js"

/** Number of known values from which columns are painted. Fewer would show the shares at one value at all values. */
const FEWEST_COLUMNS = 5

/**
 * Paint the columns of the known values, each halfway to the next ones. A value without pixels leaves its column empty.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {[place: number, stack: Stack][]} columns  places along the slider, 0 to 1, in any order
 */
export function paintShares(canvas, columns) {
  const {clientWidth: width, clientHeight: height} = canvas
  const context = contextFor(canvas, {width, height})
  if (!context) return
  context.setTransform(1, 0, 0, 1, 0, 0)
  context.clearRect(0, 0, canvas.width, canvas.height)
  if (columns.length < FEWEST_COLUMNS) return
  const known = [...columns].sort(([place], [other]) => place - other)
  known.forEach(([place, stack], k) => {
    const [left, right] = [known[k - 1]?.[0] ?? -place, known[k + 1]?.[0] ?? 2 - place].map(other => (place + other) / 2)
    paintColumn(context, left, right, stack)
  })
}

/**
 * Paint the stack of a value between two places.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {number} from
 * @param {number} to
 * @param {Stack} stack
 */
function paintColumn(context, from, to, stack) {
  const {width, height} = context.canvas
  // Columns that begin and end between two pixels of the screen would leave gaps.
  const [left, right] = [Math.round(from * width), Math.round(to * width)]
  const total = stack.reduce((sum, [, count]) => sum + count, 0)
  let sum = 0
  for (const [colour, count] of stack) {
    const top = Math.round((sum / total) * height)
    sum += count
    context.fillStyle = colour
    context.fillRect(left, top, right - left, Math.round((sum / total) * height) - top)
  }
}
