// @ts-check
/** The places of the pictures on the screen, and canvases over them. */

/**
 * A picture: the view of Bokeh, and the box of the frame on the screen.
 *
 * @typedef {{view: any, box: DOMRect}} Frame
 */

/** The frames of the maps. @returns {Frame[]} */
export function frames() {
  // The server numbers the maps by tags, see `_paint` in `app/views/maps/map_plots.py`.
  const views = [...Bokeh.index.all_views()].filter(view => view.model.tags?.[0] === "map")
  views.sort((one, other) => one.model.tags[1] - other.model.tags[1])
  return views.map(withBox).filter(({box}) => box.width > 0)
}

/** The frame of the well; undefined on a narrow screen that shows a map. @returns {Frame | undefined} */
export function wellFrame() {
  const view = [...Bokeh.index.all_views()].find(view => view.model.name === "well")
  const frame = view && withBox(view)
  return frame?.box.width ? frame : undefined
}

/** @type {(view: any) => Frame} */
function withBox(view) {
  const canvas = view.canvas_view.el.getBoundingClientRect()
  const {left, top, width, height} = view.frame.bbox
  // The canvas of a picture that a narrow screen hides has no size: its box is empty.
  return {view, box: new DOMRect(canvas.left + left, canvas.top + top, canvas.width && width, canvas.height && height)}
}

/**
 * Call a function whenever a picture has moved, or the theme has changed.
 *
 * No event reports all causes: windows, layers and panels change the layout, and Bokeh follows later, so the boxes are
 * compared before each repaint of the screen.
 *
 * @param {() => void} call
 * @returns {() => void} a function that ends the calls
 */
export function onMoved(call) {
  let frame = 0
  let lastState = ""
  const look = () => {
    const boxes = [wellFrame()?.box, frames()[0]?.box]
    const state = JSON.stringify([boxes, devicePixelRatio, document.documentElement.dataset.theme])
    if (state !== lastState) call()
    lastState = state
    frame = requestAnimationFrame(look)
  }
  frame = requestAnimationFrame(look)
  return () => cancelAnimationFrame(frame)
}

/**
 * Make a canvas cover a box on the screen, and return its context, in pixels of the box.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {DOMRect} box
 */
export function cover(canvas, box) {
  const ratio = window.devicePixelRatio
  const [width, height] = [Math.round(box.width * ratio), Math.round(box.height * ratio)]
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height})
  Object.assign(canvas.style, {
    display: "block",
    left: `${box.left}px`,
    top: `${box.top}px`,
    width: `${box.width}px`,
    height: `${box.height}px`,
  })
  const context = canvas.getContext("2d")
  context?.setTransform(ratio, 0, 0, ratio, 0, 0)
  return context
}

/**
 * Draw a line with coordinates in a window, which fills the box.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {import("../engine/starts.js").Window} window
 * @param {DOMRect} box
 * @param {{xs: ArrayLike<number>, ys: ArrayLike<number>}} line
 * @param {string} colour
 * @param {number} width
 */
export function strokeLine(context, {xLow, xHigh, ordinateLow, ordinateHigh}, box, {xs, ys}, colour, width) {
  const [scaleX, scaleY] = [box.width / (xHigh - xLow), box.height / (ordinateHigh - ordinateLow)]
  context.strokeStyle = colour
  context.lineWidth = width
  context.beginPath()
  for (let i = 0; i < xs.length; i++) context.lineTo((xs[i] - xLow) * scaleX, (ordinateHigh - ys[i]) * scaleY)
  context.stroke()
}
