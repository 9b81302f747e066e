// @ts-check
/** The line from a start on a map to the point of its orbit in the well. */

import {follow, wake} from "./motion.js"
import {mapPictures, wellPicture} from "./pictures.js"

/** Style of the line, which is over the pictures and the card, and below drawers. */
const STYLE = `position:fixed;inset:0;width:100%;height:100%;pointer-events:none;z-index:6;
  filter:drop-shadow(0 0 1px var(--ui-page)) drop-shadow(0 0 1px var(--ui-page))`

/** Attributes of a line of dots. */
const DOTS = {"stroke-dasharray": "0 6", "stroke-width": "3", "stroke-linecap": "round"}

/**
 * A line on the screen.
 *
 * @typedef {object} Line
 * @property {[number, number]} from  on a map, in pixels
 * @property {[number, number]} to  in the well, in pixels
 * @property {string} colour
 */

/** Joins the start under the pointer, or else the chosen start, with its orbit, for as long as the page exists. */
export class StartLine {
  /**
   * @param {HTMLElement} el  gets the line
   * @param {() => boolean} isCovered  whether previews cover the pictures
   */
  constructor(el, isCovered) {
    this.#isCovered = isCovered
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg")
    svg.style.cssText = STYLE
    svg.setAttribute("class", "start-line")
    svg.setAttribute("aria-hidden", "true")
    this.#line = document.createElementNS("http://www.w3.org/2000/svg", "line")
    for (const [name, value] of Object.entries(DOTS)) this.#line.setAttribute(name, value)
    svg.append(this.#line)
    el.append(svg)
    follow(
      () => this.#pointed ?? this.#chosen(),
      line => this.#draw(line),
    )
  }

  #isCovered
  #line
  /** The line of the start under the pointer; null for none. @type {Line | null} */
  #pointed = null

  /** Draw a line for the start under the pointer; null for none. @param {Line | null} line */
  point(line) {
    this.#pointed = line
    wake()
  }

  /** @param {Line | null} line */
  #draw(line) {
    this.#line.style.display = line ? "" : "none"
    if (!line) return
    const [[x1, y1], [x2, y2]] = [line.from, line.to]
    const attributes = {x1, y1, x2, y2, stroke: line.colour}
    for (const [name, value] of Object.entries(attributes)) this.#line.setAttribute(name, String(value))
  }

  /** Return the line of the chosen start; null unless both ends are on the screen. @returns {Line | null} */
  #chosen() {
    if (this.#isCovered()) return null
    const well = wellPicture()
    const points = well && rendererOf(well, "points")
    if (!points) return null
    // The largest map, and of equal maps the first.
    const [map] = mapPictures().sort((one, other) => other.box.width - one.box.width)
    const starts = map && rendererOf(map, "starts")?.data_source.data
    // The point of the chosen orbit is the last.
    const {x, y, slot} = points.data_source.data
    const index = starts ? starts.slot.indexOf(slot.at(-1)) : -1
    if (index < 0) return null
    const [from, to] = [placeOn(map, starts.x[index], starts.y[index]), placeOn(well, x.at(-1), y.at(-1))]
    return from && to && {from, to, colour: points.glyph.fill_color.transform.palette[slot.at(-1)]}
  }
}

/**
 * Return the renderer of a picture for a data source; undefined if the picture has none.
 *
 * @param {import("./pictures.js").Picture} picture
 * @param {string} name  of the data source
 */
const rendererOf = ({view}, name) => view.model.renderers.find((/** @type {any} */ each) => each.data_source.name === name)

/**
 * Return the place of a point of a picture on the screen; null outside its frame.
 *
 * @param {import("./pictures.js").Picture} picture
 * @param {number} x
 * @param {number} y
 * @returns {[number, number] | null}
 */
function placeOn({view, box}, x, y) {
  const left = box.left + view.frame.x_scale.compute(x) - view.frame.bbox.left
  const top = box.top + view.frame.y_scale.compute(y) - view.frame.bbox.top
  const isInside = left >= box.left && left <= box.right && top >= box.top && top <= box.bottom
  return isInside ? [left, top] : null
}
