// @ts-check
/**
 * The surface of section at the energy that the visitor drags or plays, computed in the browser and painted over the chart, until
 * the server's chart of this energy is complete.
 */

import {listen} from "../energy_events.js"
import {Integrator} from "../engine/integrator.js"
import {Returns} from "../engine/returns.js"
import {isNearWindow, windowAt} from "../engine/starts.js"
import {number} from "../numbers.js"
import {sameEnergy} from "../painting/columns.js"
import {LocalWhenPresent} from "../painting/local.js"
import {pictureNamed} from "../painting/pictures.js"
import {onPresent, present} from "./present.js"

/** Name of the figure of the chart. */
const CHART = "section"
/** Number of starts along a side of the window. */
const SIDE = 13
/** Side of a dot, in pixels. */
const DOT_SIDE = 2
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
 */

class LiveSection {
  /** @param {any} model  of the component in `app/views/analysis/live_section.py` */
  constructor(model) {
    this.#model = model
    this.#canvas.style.cssText = "position:absolute;display:none;background:var(--ui-page)"
    this.#canvas.className = "live-section"
    // The dots below, of another energy, get no clicks.
    for (const event of ["pointerdown", "pointermove", "pointerup", "click"])
      this.#canvas.addEventListener(event, each => each.stopPropagation())
    const ignored = [
      onPresent(() => this.#follow()),
      listen("energydragged", () => this.#follow()),
      listen("energyshown", () => this.#follow()),
    ]
    model.on(["slice", "energy", "colours", "duration"], () => this.#follow())
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
  /** The window of the chart. */
  #window = {xLow: 0, xHigh: 1, ordinateLow: 0, ordinateHigh: 1}
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
    const energy = shown?.scene()?.energy
    if (!shown || energy === undefined || !this.#model.slice) return null
    // While the server's chart is being completed, what is shown stays.
    const served = this.#model.energy
    const isServed = served === null ? !this.#returns : sameEnergy(energy, served)
    const chart = isServed ? undefined : pictureNamed(CHART)
    return chart ? {shown, chart, energy} : null
  }

  #hide() {
    cancelAnimationFrame(this.#frame)
    this.#frame = 0
    this.#returns = null
    this.#shownKey = ""
    this.#canvas.remove()
    for (const range of this.#ranges) range.restore()
  }

  /** Paint the returns that the orbits make in the time of a frame. */
  #paint() {
    this.#frame = 0
    const scene = this.#scene
    if (!scene) return this.#hide()
    if (this.#keyOf(scene) !== this.#shownKey) this.#begin(scene)
    this.#shownKey = this.#keyOf(scene)
    const {colours} = this.#model
    /** @type {[number, number][][]} */
    const places = colours.map(() => [])
    const startTime = performance.now()
    while (this.#returns && !this.#returns.complete && performance.now() - startTime < FRAME_MS)
      this.#returns.continue((orbit, x, ordinate) => places[orbit % colours.length].push([x, ordinate]))
    this.#paintDots(scene.chart, places)
    // The chart may move or disappear, of which no event tells.
    this.#follow()
  }

  /** Return everything that determines the canvas of a scene, as text. @param {Scene} scene */
  #keyOf({shown, chart, energy}) {
    const {x_range: x, y_range: y} = chart.view.model
    const {colours, duration} = this.#model
    const style = [chart.view.frame.bbox, devicePixelRatio, colours, document.documentElement.dataset.theme]
    return JSON.stringify([energy, shown.system.key, duration, x.start, x.end, y.start, y.end, style])
  }

  /** Begin with the orbits of a scene, on an empty canvas. @param {Scene} scene */
  #begin({shown, chart, energy}) {
    const integrator = new Integrator(shown.system, shown.modules)
    this.#showWindow(chart, windowAt(integrator, this.#model.plane, energy))
    const {slice, duration} = this.#model
    this.#returns = new Returns(integrator, {slice, energy, window: this.#window, side: SIDE, duration})
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
  }

  /**
   * Keep the window of the chart, or show the default window of an energy if it differs.
   *
   * @param {import("../painting/pictures.js").Picture} chart
   * @param {import("../engine/starts.js").Window | null} defaultWindow
   */
  #showWindow({view}, defaultWindow) {
    const {x_range: x, y_range: y} = view.model
    this.#window = {xLow: x.start, xHigh: x.end, ordinateLow: y.start, ordinateHigh: y.end}
    if (!defaultWindow || isNearWindow(defaultWindow, this.#window)) return
    this.#window = defaultWindow
    const [xRange, yRange] = this.#ranges
    xRange.show({start: defaultWindow.xLow, end: defaultWindow.xHigh})
    yRange.show({start: defaultWindow.ordinateLow, end: defaultWindow.ordinateHigh})
  }

  /**
   * @param {import("../painting/pictures.js").Picture} chart
   * @param {[number, number][][]} places  of new returns, by colour
   */
  #paintDots(chart, places) {
    const [context, window] = [this.#canvas.getContext("2d"), this.#window]
    const {width, height} = chart.view.frame.bbox
    const [scaleX, scaleY] = [width / (window.xHigh - window.xLow), height / (window.ordinateHigh - window.ordinateLow)]
    places.forEach((ofColour, colour) => {
      if (!context) return
      context.fillStyle = this.#model.colours[colour]
      for (const [x, ordinate] of ofColour) {
        const [left, top] = [(x - window.xLow) * scaleX, (window.ordinateHigh - ordinate) * scaleY]
        context.fillRect(left - DOT_SIDE / 2, top - DOT_SIDE / 2, DOT_SIDE, DOT_SIDE)
      }
    })
  }
}

/**
 * Start the component.
 *
 * @param {any} model
 */
export const start = model => void new LiveSection(model)
