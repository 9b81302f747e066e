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
 * Return the place of a point of a window in a box that the window fills, in pixels from the upper left corner.
 *
 * @type {(box: {width: number, height: number}, window: import("../engine/starts.js").Window, point: [number, number]) => [number, number]}
 */
export const placeIn = (box, {xLow, xHigh, ordinateLow, ordinateHigh}, [x, ordinate]) => [
  ((x - xLow) / (xHigh - xLow)) * box.width,
  ((ordinateHigh - ordinate) / (ordinateHigh - ordinateLow)) * box.height,
]

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
export function strokeLine(context, window, box, {xs, ys}, colour, width) {
  context.strokeStyle = colour
  context.lineWidth = width
  context.beginPath()
  for (let i = 0; i < xs.length; i++) context.lineTo(...placeIn(box, window, [xs[i], ys[i]]))
  context.stroke()
}
