// @ts-check
/**
 * The orbit under the pointer, drawn on a card. The card covers the picture of the well, or on a narrow screen a part of the only
 * map. A finger shows orbits after it has rested on a map, also while it then moves.
 */

import {LimitingCurves} from "../../../../plots/browser/modules/engine/curves.js"
import {Integrator} from "../../../../plots/browser/modules/engine/integrator.js"
import {findPath} from "../../../../plots/browser/modules/engine/path.js"
import {windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {cover} from "../../../../plots/browser/modules/painting/canvas.js"
import {describeOutcome, drawOrbit, drawWell, writeText} from "../../../../plots/browser/modules/painting/orbit_drawing.js"
import {mapPictures, wellPicture} from "../painting/pictures.js"

/** Longest time for which an orbit is followed, in units of the well. */
const LONGEST_TIME = 200
/** Time for which a finger must rest to show orbits instead of moving the picture, in ms. */
const PRESS_MS = 350
/** Time after the last turn of a wheel in which the maps get their new places, in ms. */
const WHEEL_REST_MS = 300
/** Largest movement of a resting finger, in pixels. */
const PRESS_PIXELS = 8
/** Distance from a click within which the card stays hidden, in pixels. */
const CLICK_PIXELS = 12
/** Side of the card over the only map, as a share of the width of the map. */
const SHARE_OF_MAP = 0.55
const STYLE = `position:fixed;pointer-events:none;z-index:5;display:none;background:var(--ui-page,#fff);
  border:1px solid var(--ui-edge,#ccc);border-radius:4px;box-sizing:border-box`

/** Shows the orbit under the pointer, for as long as the page exists. */
export class Card {
  /**
   * @param {HTMLElement} el  gets the card
   * @param {import("../painting/start_line.js").StartLine} startLine  joins the start with its orbit
   * @param {import("../painting/relief.js").Relief} relief
   * @param {() => import("../../../../plots/browser/modules/workers/frames.js").Scene | null} scene  what the pictures show
   * @param {() => any} maps  the columns of the data source of the maps
   * @param {() => {colours: string[], labels: string[]}} view  colours and labels of the outcomes
   */
  constructor(el, startLine, relief, scene, maps, view) {
    this.#startLine = startLine
    this.#relief = relief
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
    document.addEventListener("wheel", event => this.#wheel(event), {capture: true, passive: true})
  }

  #startLine
  #relief
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
  /** The next report of the place of a mouse that has turned its wheel. @type {ReturnType<typeof setTimeout> | undefined} */
  #report = undefined

  /**
   * @param {import("../../../../plots/browser/modules/engine/system.js").System} system
   * @param {import("../../../../plots/browser/modules/engine/integrator.js").Modules} modules
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

  /**
   * Hide the card while the maps are enlarged under a resting mouse. Then report its place again, for the card and for the texts
   * of Bokeh, which has another start under it.
   *
   * @param {WheelEvent} event
   */
  #wheel(event) {
    this.#hide()
    clearTimeout(this.#report)
    const [target] = event.composedPath()
    const {clientX, clientY} = event
    const options = {bubbles: true, composed: true, pointerType: "mouse", clientX, clientY}
    this.#report = setTimeout(() => target?.dispatchEvent(new PointerEvent("pointermove", options)), WHEEL_REST_MS)
  }

  /** Show the orbit under the mouse, or under a finger that has rested. @param {PointerEvent} event */
  #move(event) {
    clearTimeout(this.#report)
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
    if (path) this.#draw(picture, event, path)
    else this.#hide()
  }

  #hide() {
    this.#canvas.style.display = "none"
    this.#startLine.point(null)
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
   * @param {PointerEvent} event
   * @param {import("../../../../plots/browser/modules/engine/path.js").Path} path
   */
  #draw(picture, event, path) {
    const [integrator, context] = [this.#integrator, this.#canvas.getContext("2d")]
    if (!integrator || !context) return
    const {system} = integrator
    const box = placeFor(picture, event.clientX)
    const energy = path.energy * system.units.energy
    const window = windowAt(integrator, "x_y", energy)
    if (!window) return this.#hide()
    cover(this.#canvas, box)
    context.clearRect(0, 0, box.width, box.height)
    const style = getComputedStyle(this.#canvas)
    const [ink, paper] = ["--ui-ink", "--ui-page"].map(name => style.getPropertyValue(name))
    const limit = this.#limits.trace(integrator, {slice: system.space, window, energy})
    const {colours, labels} = this.#view()
    const well = {window, energy, limit, colours, ink}
    this.#relief.paint(context, box, window)
    drawWell(context, box, integrator, well)
    const [left, top] = drawOrbit(context, box, well, path, system.units)
    this.#startLine.point({from: [event.clientX, event.clientY], to: [box.left + left, box.top + top], colour: ink})
    const text = describeOutcome(path, system.units.time, labels)
    writeText(context, text, box, ink, paper)
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
