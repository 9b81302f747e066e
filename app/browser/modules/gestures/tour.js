// @ts-check
/** The tour of the page: a box with the text of each step, beside the parts of the page that the step is about. */

import {follow} from "../painting/motion.js"
import {mapPictures, wellPicture} from "../painting/pictures.js"

/** @typedef {{title: string, text: string, about: string[]}} Step */
/** @typedef {{left: number, top: number, right: number, bottom: number}} Box */
/** @typedef {{width: number, height: number}} Size */
/** @typedef {{index: number, parts: DOMRect[], size: Size, isNarrow: boolean, window: number[]}} Seen  the size is that of the box */

/** Space around the box, in pixels. */
const GAP = 8
/** Width of a frame, in pixels. */
const FRAME = 3
/** Windows in which the maps are above all other parts, as in the stylesheet. */
const NARROW = "(max-width: 37.49em) and (max-aspect-ratio: 3/2), (max-width: 56.24em) and (min-height: 32.01em)"

/** @type {(name: string) => DOMRect | undefined} */
const boxOfClass = name =>
  [...Bokeh.index.all_views()].find(view => view.model.css_classes?.includes(name))?.el.getBoundingClientRect()

/** The boxes of the parts, by the names of `TourPart` in `app/state/tour.py`. @type {Record<string, () => DOMRect | undefined>} */
const PARTS = {
  map: () => mapPictures()[0]?.box,
  well: () => wellPicture()?.box,
  energy: () => boxOfClass("energy"),
  analysis: () => boxOfClass("analysis"),
}

/**
 * Return the left and the top of the box of the tour: inside the area, and of all places the first that covers least of the parts.
 *
 * @param {Box[]} parts  that the step is about, at least one
 * @param {Size} size  of the box of the tour
 * @param {Box} area  of the window that the box may cover
 * @param {boolean} isNarrow  whether the box is at the foot, or else at the head, of the area
 * @returns {[number, number]}
 */
export function placeBox(parts, {width, height}, area, isNarrow) {
  const [left, top] = [Math.min(...parts.map(part => part.left)), Math.min(...parts.map(part => part.top))]
  const [right, bottom] = [Math.max(...parts.map(part => part.right)), Math.max(...parts.map(part => part.bottom))]
  const middle = (area.left + area.right - width) / 2
  const ends = [area.bottom, area.top].map(end => [middle, end])
  const beside = [[right + GAP, top], [left - GAP - width, top], [left, bottom + GAP], [left, top - GAP - height]] // prettier-ignore
  /** @type {[number, number][]} */
  const places = (isNarrow ? ends : beside).map(([x, y]) => [
    Math.max(Math.min(x, area.right - GAP - width), area.left + GAP),
    Math.max(Math.min(y, area.bottom - GAP - height), area.top + GAP),
  ])
  const covered = (/** @type {[number, number]} */ [x, y]) =>
    parts.reduce((sum, part) => sum + overlap(part, {left: x, top: y, right: x + width, bottom: y + height}), 0)
  return places.reduce((best, place) => (covered(place) < covered(best) ? place : best))
}

/** The area that two boxes share. @type {(one: Box, other: Box) => number} */
const overlap = (one, other) =>
  Math.max(Math.min(one.right, other.right) - Math.max(one.left, other.left), 0) *
  Math.max(Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top), 0)

/** @type {<Name extends keyof HTMLElementTagNameMap>(name: Name, attributes: object) => HTMLElementTagNameMap[Name]} */
const make = (name, attributes) => Object.assign(document.createElement(name), attributes)

/** A tour under way: its elements are on the page until it ends. */
class Tour {
  /** @param {Step[]} steps @param {HTMLElement | null} opener  gets the focus at the end */
  constructor(steps, opener) {
    this.#steps = steps
    this.#opener = opener
    const buttons = make("div", {})
    buttons.append(this.#back, this.#next, this.#count, this.#close)
    for (const [name, value] of Object.entries({
      "role": "dialog",
      "aria-labelledby": "tour-title",
      "aria-describedby": "tour-text",
    })) {
      this.#box.setAttribute(name, value)
    }
    // Keys of the page act while the focus is in the box.
    this.#box.ariaModal = "false"
    this.#text.ariaLive = "polite"
    this.#box.append(this.#title, this.#text, buttons)
    this.#back.onclick = () => this.#show(this.#index - 1)
    this.#next.onclick = () => (this.#isLast ? this.end() : this.#show(this.#index + 1))
    this.#close.onclick = () => this.end()
    document.addEventListener("keydown", this.#endAtEscape, true)
    document.body.append(this.#box)
    this.#show(0)
    this.#next.focus({preventScroll: true})
    this.#ignoreMoves = follow(
      () => this.#look(),
      seen => this.#place(seen),
    )
  }

  #steps
  #opener
  #index = 0
  #ignoreMoves
  #box = make("section", {className: "tour"})
  #title = make("h2", {id: "tour-title"})
  #text = make("p", {id: "tour-text"})
  #count = make("small", {})
  #back = make("button", {type: "button", textContent: "Back"})
  #next = make("button", {type: "button", textContent: "Next", className: "next"})
  #close = make("button", {type: "button", textContent: "Close"})
  /** @type {HTMLElement[]} */
  #frames = []

  /** Whether the step is the last one. */
  get #isLast() {
    return this.#index === this.#steps.length - 1
  }

  /** @param {number} index of the step */
  #show(index) {
    const {title, text} = this.#steps[index]
    this.#index = index
    this.#title.textContent = title
    this.#text.textContent = text
    this.#count.textContent = `${index + 1} of ${this.#steps.length}`
    this.#back.disabled = index === 0
    this.#next.textContent = this.#isLast ? "Done" : "Next"
    // A disabled button would lose the focus.
    if (this.#back.disabled) this.#next.focus()
    // All parts are at the top of the page.
    window.scrollTo(0, 0)
  }

  /** Return what determines the places of box and frames. @returns {Seen} */
  #look() {
    const isNarrow = matchMedia(NARROW).matches
    const {about} = this.#steps[this.#index]
    const parts = (isNarrow ? about.slice(0, 1) : about).map(name => PARTS[name]()).filter(box => box !== undefined)
    const {offsetWidth: width, offsetHeight: height} = this.#box
    return {index: this.#index, parts, size: {width, height}, isNarrow, window: [innerWidth, innerHeight]}
  }

  /** @param {Seen} seen */
  #place({parts: boxes, size, isNarrow}) {
    const top = document.querySelector(".frame-header")?.getBoundingClientRect().bottom ?? 0
    const area = {left: 0, top, right: document.documentElement.clientWidth, bottom: innerHeight}
    const parts = boxes.map(box => insideOf(area.right, area.bottom, box)).filter(box => box.top < box.bottom)
    for (const frame of this.#frames) frame.remove()
    this.#frames = parts.map(part => {
      const frame = make("div", {className: "tour-frame"})
      setBox(frame, part)
      return frame
    })
    document.body.append(...this.#frames)
    // On a phone that shows the well, the only part of a step may not be on the page.
    const [left, boxTop] = placeBox(parts.length ? parts : [{...area, bottom: area.top}], size, area, isNarrow)
    Object.assign(this.#box.style, {left: `${left}px`, top: `${boxTop}px`})
  }

  /** @param {KeyboardEvent} event */
  #endAtEscape = event => {
    if (event.key !== "Escape") return
    // The page would also close a drawer, or stop the map.
    event.preventDefault()
    this.end()
  }

  /** Remove the tour from the page, and return the focus. */
  end() {
    this.#ignoreMoves()
    document.removeEventListener("keydown", this.#endAtEscape, true)
    for (const element of [this.#box, ...this.#frames]) element.remove()
    // The card that began the tour is hidden once there are orbits.
    const opener = this.#opener?.checkVisibility() ? this.#opener : document.getElementById("stage")
    opener?.focus({preventScroll: true})
  }
}

/** The part of a box whose frame is inside the window. @type {(width: number, height: number, box: DOMRect) => Box} */
const insideOf = (width, height, {left, top, right, bottom}) => ({
  left: Math.max(left, FRAME),
  top: Math.max(top, FRAME),
  right: Math.min(right, width - FRAME),
  bottom: Math.min(bottom, height - FRAME),
})

/** @param {HTMLElement} element @param {Box} box */
function setBox(element, {left, top, right, bottom}) {
  const places = {left, top, width: right - left, height: bottom - top}
  for (const [name, value] of Object.entries(places)) element.style.setProperty(name, `${value}px`)
}

/** @type {Tour | null} */
let tour = null

/**
 * Begin the tour at its first step; a tour under way ends.
 *
 * @param {Step[]} steps
 * @param {HTMLElement | null} opener  the element that gets the focus when the tour ends
 */
export function startTour(steps, opener) {
  tour?.end()
  tour = new Tour(steps, opener)
}
