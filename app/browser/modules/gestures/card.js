// @ts-check
/**
 * The orbit under the pointer, drawn on a card. The card covers the picture of the well, or on a narrow screen a part of the only
 * map. A finger shows orbits after it has rested on a map, also while it then moves.
 */

import {exitLines, LimitingCurves} from "../engine/curves.js"
import {Integrator} from "../engine/integrator.js"
import {findPath} from "../engine/path.js"
import {windowAt} from "../engine/starts.js"
import {number} from "../numbers.js"
import {cover, mapPictures, strokeLine, wellPicture} from "../painting/pictures.js"

/** Longest time for which an orbit is followed, in units of the well. */
const LONGEST_TIME = 200
/** Time for which a finger must rest to show orbits instead of moving the picture, in ms. */
const PRESS_MS = 350
/** Largest movement of a resting finger, in pixels. */
const PRESS_PIXELS = 8
/** Distance from a click within which the card stays hidden, in pixels. */
const CLICK_PIXELS = 12
/** Side of the card over the only map, as a share of the width of the map. */
const SHARE_OF_MAP = 0.55
/** Radius of the point that marks the start, in pixels. */
const START_RADIUS = 3.5
/** Space around the text, in pixels. */
const PADDING = 6
/** Height of the line of text, in pixels. */
const TEXT_HEIGHT = 22
const STYLE = `position:fixed;pointer-events:none;z-index:5;display:none;background:var(--ui-page,#fff);
  border:1px solid var(--ui-edge,#ccc);border-radius:4px;box-sizing:border-box`

/**
 * Describe the outcome of an orbit.
 *
 * @param {Pick<import("../engine/path.js").Path, "channel" | "time" | "crossings">} path
 * @param {number} unit  unit of time of the well, in units of the page
 * @param {string[]} labels  of the outcomes, exits first
 */
export function describeOutcome({channel, time, crossings}, unit, labels) {
  const crossingCount = crossings === 1 ? "1 crossing" : `${crossings} crossings`
  const label = labels[channel - 1] ?? "inside until"
  return `${label[0].toUpperCase()}${label.slice(1)} ${channel > 0 ? "at " : ""}t = ${number(time * unit)}, ${crossingCount}`
}

/**
 * Return the points of an orbit in units of the page.
 *
 * @param {Pick<import("../engine/path.js").Path, "x" | "y">} path
 * @param {{length: number}} units  units of the well, in units of the page
 */
export function toPageUnits({x, y}, {length}) {
  const [xs, ys] = [x, y].map(values => values.map(value => value * length))
  return {xs, ys}
}

/** Shows the orbit under the pointer, for as long as the page exists. */
export class Card {
  /**
   * @param {HTMLElement} el  gets the card
   * @param {() => import("../workers/frames.js").Scene | null} scene  what the pictures show
   * @param {() => any} maps  the columns of the data source of the maps
   * @param {() => {colours: string[], labels: string[]}} view  colours and labels of the outcomes
   */
  constructor(el, scene, maps, view) {
    this.#scene = scene
    this.#maps = maps
    this.#view = view
    this.#canvas = document.createElement("canvas")
    this.#canvas.className = "orbit-card"
    this.#canvas.style.cssText = STYLE
    this.#canvas.setAttribute("role", "img")
    el.append(this.#canvas)
    document.addEventListener("pointermove", event => this.#move(event), true)
    document.addEventListener("pointerdown", event => this.#press(event), true)
    document.addEventListener("pointerup", () => this.#lift(), true)
    document.addEventListener("pointercancel", () => this.#lift(), true)
    document.addEventListener("pointerleave", () => this.#hide())
    // The browser would scroll the page, or open a menu, while a finger shows orbits.
    for (const name of ["touchmove", "contextmenu"]) {
      document.addEventListener(name, event => this.#isShowing && event.preventDefault(), {capture: true, passive: false})
    }
    document.addEventListener("scroll", () => this.#hide(), {capture: true, passive: true})
  }

  #scene
  #maps
  #view
  #canvas
  #limits = new LimitingCurves()
  /** @type {Integrator | null} */
  #integrator = null
  /** @type {{timer: ReturnType<typeof setTimeout>, x: number, y: number} | null} */
  #finger = null
  /** Whether a finger shows orbits. */
  #isShowing = false
  /** Where the mouse was last pressed, until it moves away. @type {{x: number, y: number} | null} */
  #clickPoint = null

  /**
   * @param {import("../engine/system.js").System} system
   * @param {import("../engine/integrator.js").Modules} modules
   */
  setSystem(system, modules) {
    this.#integrator = new Integrator(system, modules)
  }

  /** Hide the card at a click, or wait until a finger has rested. @param {PointerEvent} event */
  #press(event) {
    this.#lift()
    const picture = this.#mapAt(event)
    if (event.pointerType !== "touch") {
      // A click chooses the orbit, and the page draws it where the card was.
      this.#clickPoint = {x: event.clientX, y: event.clientY}
      this.#hide()
      return
    }
    if (!picture) return
    const timer = setTimeout(() => {
      this.#isShowing = true
      this.#show(picture, event)
    }, PRESS_MS)
    this.#finger = {timer, x: event.clientX, y: event.clientY}
  }

  /** End the gesture of a finger. */
  #lift() {
    if (this.#finger) clearTimeout(this.#finger.timer)
    if (this.#isShowing) this.#hide()
    this.#finger = null
    this.#isShowing = false
  }

  /** Show the orbit under the mouse, or under a finger that has rested. @param {PointerEvent} event */
  #move(event) {
    if (event.pointerType === "touch") {
      const finger = this.#finger
      // Bokeh would move the picture.
      if (this.#isShowing) event.stopPropagation()
      else if (finger && distance(finger, event) > PRESS_PIXELS) this.#lift()
      if (!this.#isShowing) return
    }
    if (this.#clickPoint && distance(this.#clickPoint, event) < CLICK_PIXELS) return
    this.#clickPoint = null
    // No card appears while the mouse drags the energy or the window.
    const isDragging = event.buttons && event.pointerType !== "touch"
    this.#show(isDragging ? undefined : this.#mapAt(event), event)
  }

  /**
   * Return the map under the pointer; undefined for none.
   *
   * @param {PointerEvent} event
   */
  #mapAt(event) {
    const onMap = event.composedPath().some(node => node instanceof Element && node.classList.contains("map"))
    return onMap ? mapPictures().find(({box}) => contains(box, event)) : undefined
  }

  /**
   * Show the orbit that starts at the pointer, or hide the card if there is none.
   *
   * @param {import("../painting/pictures.js").Picture | undefined} picture  the map under the pointer
   * @param {PointerEvent} event
   */
  #show(picture, event) {
    const [scene, integrator] = [this.#scene(), this.#integrator]
    if (!picture || !scene || !integrator) {
      this.#hide()
      return
    }
    const start = this.#pixelCentre(picture, event)
    const {units} = scene.slice
    const energy = scene.energy / integrator.system.units.energy
    const path = findPath(integrator, scene.slice, energy, [start[0] / units[0], start[1] / units[1]], LONGEST_TIME)
    if (path) this.#draw(picture, event.clientX, path)
    else this.#hide()
  }

  #hide() {
    this.#canvas.style.display = "none"
  }

  /**
   * Return the centre of the pixel under the pointer, in units of the page. The grid of pixels continues beyond the image.
   *
   * @param {import("../painting/pictures.js").Picture} picture
   * @param {PointerEvent} event
   * @returns {[number, number]}
   */
  #pixelCentre({box, view}, event) {
    const {x, y, dw, dh, fate} = this.#maps()
    const point = [
      view.frame.x_scale.invert(event.clientX - box.left + view.frame.bbox.left),
      view.frame.y_scale.invert(event.clientY - box.top + view.frame.bbox.top),
    ]
    const [rows, columns] = fate[0].shape
    return [cellCentre(point[0], x[0], dw[0], columns), cellCentre(point[1], y[0], dh[0], rows)]
  }

  /**
   * Draw an orbit in the well, with the limiting curve and the exits, and its outcome as text.
   *
   * @param {import("../painting/pictures.js").Picture} picture  under the pointer
   * @param {number} pointerLeft  distance of the pointer from the left of the screen, in pixels
   * @param {import("../engine/path.js").Path} path
   */
  #draw(picture, pointerLeft, path) {
    const [integrator, context] = [this.#integrator, this.#canvas.getContext("2d")]
    if (!integrator || !context) return
    const {system} = integrator
    const box = placeFor(picture, pointerLeft)
    const energy = path.energy * system.units.energy
    const window = windowAt(integrator, "x_y", energy)
    if (!window) return this.#hide()
    cover(this.#canvas, box)
    context.clearRect(0, 0, box.width, box.height)
    const style = getComputedStyle(this.#canvas)
    const [ink, paper] = ["--ui-ink", "--ui-page"].map(name => style.getPropertyValue(name))
    const draw = strokeLine.bind(null, context, window, box)
    const limit = this.#limits.trace(integrator, {slice: system.space, window, energy})
    for (const line of limit) draw(line, ink, 1.5)
    const {colours, labels} = this.#view()
    for (const {channel, xs, ys} of exitLines(integrator, energy)) draw({xs, ys}, colours[channel - 1], 3)
    const {xs, ys} = toPageUnits(path, system.units)
    draw({xs, ys}, path.channel > 0 ? colours[path.channel - 1] : ink, 1)
    context.fillStyle = ink
    context.beginPath()
    const scale = box.width / (window.xHigh - window.xLow)
    context.arc((xs[0] - window.xLow) * scale, (window.ordinateHigh - ys[0]) * scale, START_RADIUS, 0, 2 * Math.PI)
    context.fill()
    this.#writeText(context, describeOutcome(path, system.units.time, labels), box, ink, paper)
  }

  /**
   * Write text in the lower left corner, and for screen readers.
   *
   * @param {CanvasRenderingContext2D} context
   * @param {string} text
   * @param {DOMRect} box
   * @param {string} ink  colour of the text
   * @param {string} paper  colour behind the text
   */
  #writeText(context, text, box, ink, paper) {
    context.font = "12px system-ui, sans-serif"
    context.fillStyle = paper
    context.fillRect(0, box.height - TEXT_HEIGHT, context.measureText(text).width + 2 * PADDING, TEXT_HEIGHT)
    context.fillStyle = ink
    // On a small card the text is compressed.
    context.fillText(text, PADDING, box.height - PADDING, box.width - 2 * PADDING)
    this.#canvas.setAttribute("aria-label", text)
  }
}

/**
 * Return the centre of the cell that contains a value, if `count` cells divide the interval from `low` to `low + size`.
 *
 * @type {(value: number, low: number, size: number, count: number) => number}
 */
const cellCentre = (value, low, size, count) => low + (size * (Math.floor(((value - low) / size) * count) + 0.5)) / count

/**
 * Return the distance of the pointer from a point of the screen, in pixels.
 *
 * @type {(point: {x: number, y: number}, event: PointerEvent) => number}
 */
const distance = ({x, y}, {clientX, clientY}) => Math.hypot(clientX - x, clientY - y)

/** Whether the pointer is in a box. @type {(box: DOMRect, event: PointerEvent) => boolean} */
const contains = (box, {clientX, clientY}) =>
  clientX >= box.left && clientX <= box.right && clientY >= box.top && clientY <= box.bottom

/**
 * Return the place of the card: over the well, or over the only map on the side away from the pointer.
 *
 * @param {import("../painting/pictures.js").Picture} picture  under the pointer
 * @param {number} pointerLeft  distance of the pointer from the left of the screen, in pixels
 */
function placeFor(picture, pointerLeft) {
  const well = wellPicture()
  if (well) return well.box
  const {left, top, width} = picture.box
  const side = SHARE_OF_MAP * width
  return new DOMRect(pointerLeft < left + width / 2 ? left + width - side : left, top, side, side)
}
