// @ts-check
/** The two pictures of a live figure: the map, and the well with orbits. */

import {exitLines, LimitingCurves} from "../engine/curves.js"
import {showsPositions, windowAt} from "../engine/starts.js"
import {contextFor, placeIn, strokeLine} from "../painting/canvas.js"
import {pixelColumns} from "../painting/columns.js"
import {describeOutcome, drawOrbit, drawWell, writeText} from "../painting/orbit_drawing.js"
import {PixelImage} from "../painting/pixel_image.js"
import {drawAxes, MARGINS} from "./axes.js"
import {IMAGE_TYPES} from "./data.js"

/** Radius of the mark of a start, in pixels. */
const MARK_RADIUS = 8

/** Return the colours of text and paper in the theme of the visitor. */
function theme() {
  const style = getComputedStyle(document.documentElement)
  const [ink, paper] = ["--ui-ink", "--ui-page"].map(name => style.getPropertyValue(name).trim())
  return {ink, paper}
}

/** A canvas with axes around a square frame. */
class Axes {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {[string, string]} labels
   */
  constructor(canvas, labels) {
    this.canvas = canvas
    this.#labels = labels
  }

  #labels

  /** The frame on the screen. */
  get frame() {
    const {left, top, width, height} = this.canvas.getBoundingClientRect()
    return new DOMRect(
      left + MARGINS.left,
      top + MARGINS.top,
      width - MARGINS.left - MARGINS.right,
      height - MARGINS.top - MARGINS.bottom,
    )
  }

  /**
   * Empty the canvas, draw the axes, and draw in the frame.
   *
   * @param {import("../engine/starts.js").Window} window
   * @param {(context: CanvasRenderingContext2D, box: {width: number, height: number}) => void} draw
   */
  paint(window, draw) {
    const {left, right, top, bottom} = MARGINS
    const {width} = this.canvas.getBoundingClientRect()
    const side = width - left - right
    const height = side + top + bottom
    this.canvas.style.height = `${height}px`
    const context = contextFor(this.canvas, {width, height})
    if (!context) return
    context.clearRect(0, 0, width, height)
    const box = {left, top, width: side, height: side}
    context.save()
    drawAxes(context, box, window, this.#labels, theme().ink)
    context.restore()
    context.save()
    context.translate(box.left, box.top)
    context.beginPath()
    context.rect(0, 0, box.width, box.height)
    context.clip()
    draw(context, box)
    context.restore()
  }
}

/**
 * Pixels in a window: exact ones as images by the names of pictures, or those of a preview as columns.
 *
 * @typedef {object} Shown
 * @property {import("../engine/starts.js").Window} window
 * @property {Record<string, HTMLImageElement> | null} exact
 * @property {import("../painting/columns.js").Columns | null} columns
 */

/** The picture of the map. */
export class MapPicture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./data.js").FigureData} data
   * @param {import("../engine/integrator.js").Integrator} integrator
   */
  constructor(canvas, data, integrator) {
    this.#axes = new Axes(canvas, data.axes)
    this.#data = data
    this.#integrator = integrator
  }

  #axes
  #data
  #integrator
  #limits = new LimitingCurves()
  #image = new PixelImage()

  /** The frame on the screen. */
  get frame() {
    return this.#axes.frame
  }

  /**
   * Return the pixels of a preview.
   *
   * @param {import("../engine/pixels.js").View} view
   * @param {import("../engine/pixels.js").Pixels} pixels
   * @returns {Shown}
   */
  preview(view, pixels) {
    return {window: view.window, exact: null, columns: pixelColumns(this.#data.coding, view, pixels, IMAGE_TYPES, null)}
  }

  /**
   * Draw the map.
   *
   * @param {import("../engine/starts.js").Window} window
   * @param {number} energy  in units of the page
   * @param {import("./data.js").PictureData} picture
   * @param {Shown} shown  the pixels, possibly of another window
   * @param {[number, number][]} starts  of the chosen orbits
   */
  draw(window, energy, picture, shown, starts) {
    const {slice, colours, orbits} = this.#data
    const {ink, paper} = theme()
    this.#axes.paint(window, (context, box) => {
      this.#drawPixels(context, box, window, picture, shown)
      for (const line of this.#limits.trace(this.#integrator, {slice, window, energy}))
        strokeLine(context, window, box, line, ink, 1.5)
      if (showsPositions(slice)) {
        for (const exit of exitLines(this.#integrator, energy))
          strokeLine(context, window, box, exit, colours[exit.channel - 1], 3)
      }
      starts.forEach((start, index) => drawMark(context, placeIn(box, window, start), index, orbits[index], paper))
    })
  }

  /**
   * Draw pixels where their window lies in the frame.
   *
   * @param {CanvasRenderingContext2D} context
   * @param {{width: number, height: number}} box
   * @param {import("../engine/starts.js").Window} window
   * @param {import("./data.js").PictureData} picture
   * @param {Shown} shown
   */
  #drawPixels(context, box, window, {name, column, colours, times}, {window: pixelWindow, exact, columns}) {
    const [left, top] = placeIn(box, window, [pixelWindow.xLow, pixelWindow.ordinateHigh])
    const [right, bottom] = placeIn(box, window, [pixelWindow.xHigh, pixelWindow.ordinateLow])
    const size = {width: right - left, height: bottom - top}
    context.save()
    context.imageSmoothingEnabled = false
    context.translate(left, top)
    if (exact) context.drawImage(exact[name], 0, 0, size.width, size.height)
    if (columns) {
      const codes = {type: "LinearColorMapper", palette: colours, low: -0.5, high: colours.length - 0.5}
      this.#image.paint(context, size, columns[column][0], codes)
      if (times) {
        const {low, high, colours: palette} = times
        this.#image.paint(context, size, columns.escape_time[0], {type: "LogColorMapper", palette, low, high})
      }
    }
    context.restore()
  }
}

/** The picture of the well. */
export class WellPicture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./data.js").FigureData} data
   * @param {import("../engine/integrator.js").Integrator} integrator
   */
  constructor(canvas, data, integrator) {
    this.#axes = new Axes(canvas, ["x", "y"])
    this.#data = data
    this.#integrator = integrator
  }

  #axes
  #data
  #integrator
  #limits = new LimitingCurves()

  /**
   * Draw the well at an energy, and an orbit with its outcome. Return the outcome.
   *
   * @param {number} energy  in units of the page
   * @param {import("../engine/path.js").Path | null} path
   */
  draw(energy, path) {
    const {labels, colours} = this.#data
    const {system} = this.#integrator
    const window = windowAt(this.#integrator, "x_y", energy)
    if (!window) return ""
    const {ink, paper} = theme()
    const text = path ? describeOutcome(path, system.units.time, labels) : ""
    this.#axes.paint(window, (context, box) => {
      const limit = this.#limits.trace(this.#integrator, {slice: system.space, window, energy})
      const well = {window, energy, limit, colours, ink}
      drawWell(context, box, this.#integrator, well)
      if (!path) return
      drawOrbit(context, box, well, path, system.units)
      writeText(context, text, box, ink, paper)
    })
    return text
  }
}

/**
 * Mark the start of a chosen orbit with its number.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {[number, number]} place
 * @param {number} index
 * @param {string} colour
 * @param {string} paper
 */
function drawMark(context, [x, y], index, colour, paper) {
  context.beginPath()
  context.arc(x, y, MARK_RADIUS, 0, 2 * Math.PI)
  context.fillStyle = paper
  context.fill()
  context.strokeStyle = context.fillStyle = colour
  context.lineWidth = 2
  context.stroke()
  context.font = "bold 11px system-ui, sans-serif"
  context.textAlign = "center"
  context.textBaseline = "middle"
  context.fillText(String(index + 1), x, y)
}
