// @ts-check
/** Canvases that cover boxes on the screen, and what is drawn on them. */

/**
 * Give a canvas as many pixels as a box of the page has on the screen, and return its context, whose unit is a pixel of the page.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{width: number, height: number}} box
 */
export function contextFor(canvas, box) {
  const ratio = window.devicePixelRatio
  const [width, height] = [Math.round(box.width * ratio), Math.round(box.height * ratio)]
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height})
  const context = canvas.getContext("2d")
  context?.setTransform(ratio, 0, 0, ratio, 0, 0)
  return context
}

/**
 * Make a canvas cover a box on the screen, and return its context, whose unit is a pixel of the page.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {DOMRect} box
 */
export function cover(canvas, box) {
  Object.assign(canvas.style, {
    display: "block",
    left: `${box.left}px`,
    top: `${box.top}px`,
    width: `${box.width}px`,
    height: `${box.height}px`,
  })
  return contextFor(canvas, box)
}

/**
 * Draw a line, with coordinates in a window that fills the box.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {import("../engine/starts.js").Window} window
 * @param {{width: number, height: number}} box
 * @param {{xs: ArrayLike<number>, ys: ArrayLike<number>}} line
 * @param {string} colour
 * @param {number} width  in pixels
 */
export function strokeLine(context, {xLow, xHigh, ordinateLow, ordinateHigh}, box, {xs, ys}, colour, width) {
  const [scaleX, scaleY] = [box.width / (xHigh - xLow), box.height / (ordinateHigh - ordinateLow)]
  context.strokeStyle = colour
  context.lineWidth = width
  context.beginPath()
  for (let i = 0; i < xs.length; i++) context.lineTo((xs[i] - xLow) * scaleX, (ordinateHigh - ys[i]) * scaleY)
  context.stroke()
}
