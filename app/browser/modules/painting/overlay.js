// @ts-check
/**
 * The pictures while the energy changes, on canvases over the pictures of Bokeh, because Bokeh takes longer to paint axes than
 * the browser takes to compute the pixels. Palettes and styles of lines come from the models of Bokeh.
 */

import {cover, strokeLine} from "../../../../plots/browser/modules/painting/canvas.js"
import {PixelImage} from "../../../../plots/browser/modules/painting/pixel_image.js"
import {mapPictures, wellPicture} from "./pictures.js"

/** Style of the canvases, which are below cards and drawers. */
const STYLE = "position:fixed;pointer-events:none;z-index:1;display:none;background:var(--ui-page)"

/**
 * The content of the canvases.
 *
 * @typedef {object} Painting
 * @property {number} energy
 * @property {import("../../../../plots/browser/modules/engine/starts.js").Window} window
 * @property {import("../../../../plots/browser/modules/painting/columns.js").Columns} columns
 * @property {Lines} lines  of the maps
 * @property {{window: import("../../../../plots/browser/modules/engine/starts.js").Window, lines: Lines} | null} well  null for a well that does not change
 *
 * Lines by the names of Bokeh's data sources.
 *
 * @typedef {Record<string, {xs: number[], ys: number[], colour?: string}[]>} Lines
 */

export class Overlay {
  /** @param {HTMLElement} el @param {import("./relief.js").Relief} relief */
  constructor(el, relief) {
    this.#el = el
    this.#relief = relief
    document.addEventListener("scroll", () => this.hide(), {capture: true, passive: true})
  }

  #el
  #relief
  /** @type {Map<string, HTMLCanvasElement>} */
  #canvases = new Map()
  #image = new PixelImage()
  #isShown = false
  /** Whether the canvases cover the pictures. */
  get isShown() {
    return this.#isShown
  }

  /** Paint all pictures on their canvases, and the well if it changes. @param {Painting} painting */
  show(painting) {
    this.#isShown = true
    const {energy, window, columns, lines, well} = painting
    for (const {view, box} of mapPictures()) {
      const context = this.#canvasFor(view.model.name, box, energy)
      if (!context) continue
      for (const {glyph, data_source: source} of view.model.renderers) {
        if (source.name === "maps") this.#image.paint(context, box, columns[glyph.image.field][0], glyph.color_mapper)
      }
      strokeLines(context, view.model, window, box, lines)
      context.canvas.dataset.side = String(columns.fate[0].shape[0])
    }
    const picture = well && wellPicture()
    const context = picture && this.#canvasFor("well", picture.box, energy)
    if (!picture || !context) return
    this.#relief.paint(context, picture.box, well.window)
    strokeLines(context, picture.view.model, well.window, picture.box, well.lines)
  }

  /** Hide the canvases after Bokeh has painted the next frame. */
  hide() {
    if (!this.#isShown) return
    this.#isShown = false
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        if (this.#isShown) return
        for (const canvas of this.#canvases.values()) canvas.style.display = "none"
      }),
    )
  }

  /**
   * Return the context of the empty canvas over a picture.
   *
   * @param {string} name
   * @param {DOMRect} box
   * @param {number} energy
   */
  #canvasFor(name, box, energy) {
    const canvas = this.#canvasOf(name)
    const context = cover(canvas, box)
    context?.clearRect(0, 0, box.width, box.height)
    if (context) context.imageSmoothingEnabled = false
    canvas.dataset.energy = String(energy)
    return context
  }

  /** Return the canvas over a picture, which the first call makes. @param {string} name */
  #canvasOf(name) {
    const canvas = this.#canvases.get(name) ?? document.createElement("canvas")
    if (!this.#canvases.has(name)) {
      canvas.style.cssText = STYLE
      this.#el.append(canvas)
      this.#canvases.set(name, canvas)
    }
    return canvas
  }
}

/**
 * Draw lines in the styles of the glyphs of a picture.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {any} plot
 * @param {import("../../../../plots/browser/modules/engine/starts.js").Window} window
 * @param {DOMRect} box
 * @param {Lines} lines
 */
function strokeLines(context, plot, window, box, lines) {
  for (const {glyph, data_source: source} of plot.renderers) {
    for (const line of lines[source.name] ?? []) {
      const colour = glyph.line_color.field ? line.colour : valueOf(glyph.line_color)
      strokeLine(context, window, box, line, colour, valueOf(glyph.line_width))
    }
  }
}

/** Return the value of a property of a glyph that is the same for all its lines. @type {(property: any) => any} */
const valueOf = property => {
  const value = property?.value ?? property
  return property?.transform ? property.transform.compute(value) : value
}
