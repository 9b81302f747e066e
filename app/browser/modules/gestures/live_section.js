// @ts-check
/**
 * The surface of section at the energy that the visitor drags or plays, computed in the browser and painted over the chart, until
 * the server's chart of this energy is complete.
 */

import {Integrator} from "../../../../plots/browser/modules/engine/integrator.js"
import {Returns} from "../../../../plots/browser/modules/engine/returns.js"
import {isNearWindow, windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {number} from "../../../../plots/browser/modules/numbers.js"
import {sameEnergy} from "../../../../plots/browser/modules/painting/columns.js"
import {Dots} from "../painting/dots.js"
import {LocalWhenPresent} from "../painting/local.js"
import {pictureNamed} from "../painting/pictures.js"
import {storeOf} from "../view_store.js"
import {onPresent, present} from "./present.js"

/** Name of the figure of the chart. */
const CHART = "section"
/** Number of starts along a side of the window. */
const SIDE = 13
/** Time in each frame for following the orbits, in ms. */
const FRAME_MS = 12
/** Digits of the energy on the canvas. */
const DIGITS = 6

/**
 * What to compute, and the chart over which it is painted.
 *
 * @typedef {object} Scene
 * @property {import("./present.js").Shown} shown
 * @property {import("../painting/pictures.js").Picture} chart
 * @property {number} energy
 * @property {import("../../../../plots/browser/modules/engine/starts.js").Window | null} window  that of the map; null for the default window
 */

class LiveSection {
  /** @param {any} model  of the component in `app/views/analysis/live_section.py` */
  constructor(model) {
    this.#model = model
    this.#canvas.style.cssText = "position:absolute;display:none;background:var(--ui-page)"
    this.#canvas.className = "live-section"
    // The dots below, of another energy or window, get no clicks.
    for (const event of ["pointerdown", "pointermove", "pointerup", "click"])
      this.#canvas.addEventListener(event, each => each.stopPropagation())
    this.#canvas.addEventListener("click", each => this.#pick(each.offsetX, each.offsetY))
    const {energy, window} = storeOf(model.document)
    const follow = () => this.#follow()
    const ignored = [onPresent(follow), energy.listen(follow), window.listen(follow)]
    model.on(["slice", "section", "served", "colouring", "duration", "follows_window"], () => this.#follow())
    model.on("lifecycle:remove", () => {
      this.#hide()
      for (const ignore of ignored) ignore()
    })
    this.#follow()
  }

  #model
  #canvas = document.createElement("canvas")
  #range = (/** @type {string} */ name) => new LocalWhenPresent(() => pictureNamed(CHART)?.view.model[name], ["start", "end"])
  #ranges = [this.#range("x_range"), this.#range("y_range")]
  /** @type {Returns | null} */
  #returns = null
  /** What is painted. @type {Dots | null} */
  #dots = null
  /** The energy of the orbits. */
  #energy = 0
  /** What the canvas shows, as text. */
  #shownKey = ""
  #frame = 0

  /** Show the section of the present energy from the next frame on, or the server's chart. */
  #follow() {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#paint())
  }

  /** What to compute; null where the server's chart is shown. @returns {Scene | null} */
  get #scene() {
    const shown = present()
    const map = shown?.scene()
    if (!shown || !map || !this.#model.slice) return null
    const {energy} = map
    const {slice, section, follows_window: follows} = this.#model
    // The pictures may still show another slice.
    const window = follows && String(map.slice.axes) === String(slice.axes) ? map.window : null
    // While the server's chart is being completed, what is shown stays.
    const served = this.#model.served?.section === section ? this.#model.served : null
    const isServed = served
      ? sameEnergy(energy, served.energy) && (!window || isNearWindow(window, served.window))
      : !this.#returns
    const chart = isServed ? undefined : pictureNamed(CHART)
    return chart ? {shown, chart, energy, window} : null
  }

  /** Start the orbit through the point nearest to a place on the canvas. @param {number} left @param {number} top */
  #pick(left, top) {
    const state = this.#dots?.nearest(left, top)
    if (state) this.#model.send_msg({state, energy: this.#energy})
  }

  #hide() {
    cancelAnimationFrame(this.#frame)
    this.#frame = 0
    if (!this.#shownKey) return
    this.#returns = this.#dots = null
    this.#shownKey = ""
    this.#canvas.remove()
    const {served} = this.#model
    if (!served) return this.#ranges.forEach(range => range.restore())
    const {xLow, xHigh, ordinateLow, ordinateHigh} = served.window
    const edges = [
      {start: xLow, end: xHigh},
      {start: ordinateLow, end: ordinateHigh},
    ]
    this.#ranges.forEach((range, axis) => range.settle(edges[axis]))
  }

  /** Paint the returns that the orbits make in the time of a frame. */
  #paint() {
    this.#frame = 0
    const scene = this.#scene
    if (!scene) return this.#hide()
    if (this.#keyOf(scene) !== this.#shownKey) {
      // Then an error does not keep the window of the chart from being restored.
      this.#shownKey = this.#keyOf(scene)
      this.#begin(scene)
      this.#shownKey = this.#keyOf(scene)
    }
    const [column, other] = this.#model.slice.sectionColumns
    const startTime = performance.now()
    while (this.#returns && !this.#returns.complete && performance.now() - startTime < FRAME_MS)
      this.#returns.continue(
        (orbit, state) => this.#dots?.add(orbit, [state[column], state[other]], state),
        (orbit, channel) => this.#dots?.end(orbit, channel),
      )
    // The chart may move or disappear, of which no event tells.
    this.#follow()
  }

  /** Return everything that determines the canvas of a scene, as text. @param {Scene} scene */
  #keyOf({shown, chart, energy, window}) {
    const {x_range: x, y_range: y} = chart.view.model
    const {colouring, duration} = this.#model
    const style = [chart.view.frame.bbox, devicePixelRatio, colouring, document.documentElement.dataset.theme]
    return JSON.stringify([energy, window, shown.system.key, duration, x.start, x.end, y.start, y.end, style])
  }

  /** Begin with the orbits of a scene, on an empty canvas. @param {Scene} scene */
  #begin({shown, chart, energy, window: mapWindow}) {
    const integrator = new Integrator(shown.system, shown.modules)
    const window = this.#showWindow(chart, mapWindow, windowAt(integrator, this.#model.plane, energy))
    const {slice, duration, colouring} = this.#model
    this.#returns = new Returns(integrator, {slice, energy, window, side: SIDE, duration, most: this.#model.returns})
    this.#energy = energy
    const {left, top, width, height} = chart.view.frame.bbox
    // Elements of Bokeh show only what their shadow root contains.
    chart.view.canvas_view.el.shadowRoot.append(this.#canvas)
    const ratio = devicePixelRatio
    // One more pixel covers the dots at the edge of the frame.
    const [right, bottom] = [width + 1, height + 1]
    Object.assign(this.#canvas, {width: Math.round(right * ratio), height: Math.round(bottom * ratio)})
    const style = {display: "block", left: `${left}px`, top: `${top}px`, width: `${right}px`, height: `${bottom}px`}
    Object.assign(this.#canvas.style, style)
    this.#canvas.dataset.energy = String(energy)
    const context = this.#canvas.getContext("2d")
    if (!context) return
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    context.font = "12px system-ui, sans-serif"
    context.fillStyle = getComputedStyle(this.#canvas).color
    context.fillText(`h = ${number(energy, DIGITS)}`, 6, height - 6)
    this.#dots = new Dots(context, {width, height}, window, {...colouring, ends: shown.colours()})
  }

  /**
   * Show the window of the map, or a default window unless that of the chart is near it; return the window that is shown.
   *
   * @param {import("../painting/pictures.js").Picture} chart
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window | null} mapWindow
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window | null} defaultWindow
   */
  #showWindow({view}, mapWindow, defaultWindow) {
    const {x_range: x, y_range: y} = view.model
    const current = {xLow: x.start, xHigh: x.end, ordinateLow: y.start, ordinateHigh: y.end}
    const window = mapWindow ?? (defaultWindow && !isNearWindow(defaultWindow, current) ? defaultWindow : current)
    const [xRange, yRange] = this.#ranges
    xRange.show({start: window.xLow, end: window.xHigh})
    yRange.show({start: window.ordinateLow, end: window.ordinateHigh})
    return window
  }
}

/**
 * Start the component.
 *
 * @param {any} model
 */
export const start = model => void new LiveSection(model)
