// @ts-check
/** Many orbits as particles in the colours of their exits, on canvases over the pictures of Bokeh. */

import {exitLines} from "../../../../plots/browser/modules/engine/curves.js"
import {windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {cover, placeIn} from "../../../../plots/browser/modules/painting/canvas.js"
import {mapPictures, wellPicture} from "./pictures.js"

/** Side of a particle, in pixels. */
const PARTICLE_SIDE = 2.5
/** Factor of the opacity of a trail from one frame to the next. */
const TRAIL_OPACITY = 0.88
/** Style of the canvases. The colour is that of orbits that stay. */
const STYLE = "position:fixed;pointer-events:none;z-index:1;display:none;color:var(--ui-quiet)"
/** Style of the canvas over the map, which covers the map. */
const COVER = "background:color-mix(in srgb, var(--ui-page) 85%, transparent)"
/** Letters of the numbers of the exits. */
const LETTERS = "bold 16px system-ui, sans-serif"
/** Width of the lines around the letters, in pixels. They cover the numbers of the picture, which are up to 3 pixels lower. */
const OUTLINE_WIDTH = 7

/**
 * @typedef {import("../../../../plots/browser/modules/engine/starts.js").Window} Window
 * @typedef {import("../gestures/present.js").Shown} Shown
 *
 * The orbits at a time.
 *
 * @typedef {object} Orbits
 * @property {import("../../../../plots/browser/modules/engine/ensemble.js").Ensemble} ensemble
 * @property {import("../../../../plots/browser/modules/engine/integrator.js").Integrator} integrator
 * @property {ArrayLike<number>} channel  number of the exit of each orbit, 0 for none
 * @property {boolean} hasTrails  whether the particles of earlier frames fade, or vanish
 */

export class Particles {
  #wellCanvas = makeCanvas(STYLE)
  #sectionCanvas = makeCanvas(`${STYLE};${COVER}`)

  /**
   * Paint the orbits over the well, and over the map of a slice on the section.
   *
   * @param {Orbits} orbits
   * @param {Shown} shown
   */
  show(orbits, shown) {
    if (!this.#wellCanvas.isConnected) shown.host.append(this.#wellCanvas, this.#sectionCanvas)
    this.#paintWell(orbits, shown)
    this.#paintSection(orbits, shown)
  }

  hide() {
    for (const canvas of [this.#wellCanvas, this.#sectionCanvas]) canvas.style.display = "none"
  }

  remove() {
    for (const canvas of [this.#wellCanvas, this.#sectionCanvas]) canvas.remove()
  }

  /** @param {Orbits} orbits @param {Shown} shown */
  #paintWell(orbits, {system, scene, colours}) {
    const {ensemble, integrator} = orbits
    const [picture, energy] = [wellPicture(), scene()?.energy]
    const window = energy === undefined ? null : windowAt(integrator, "x_y", energy)
    if (!picture || !window || energy === undefined) return void (this.#wellCanvas.style.display = "none")
    const {length} = system.units
    const context = paint(this.#wellCanvas, picture.box, window, orbits, colours(), [ensemble.x, ensemble.y], [length, length])
    if (context) writeNumbers(context, picture.box, window, exitLines(integrator, energy))
  }

  /** Each orbit is at its last crossing of the section. @param {Orbits} orbits @param {Shown} shown */
  #paintSection(orbits, {scene, colours}) {
    const [picture, view] = [mapPictures()[0], scene()]
    const points = view?.slice.sectionColumns?.map(column => orbits.ensemble.atSection(column)) ?? []
    // Before the first crossing, the map stays uncovered.
    if (!picture || !view || !points[0]?.some(Number.isFinite)) return void (this.#sectionCanvas.style.display = "none")
    paint(this.#sectionCanvas, picture.box, view.window, orbits, colours(), points, view.slice.units)
  }
}

/** @param {string} style */
function makeCanvas(style) {
  const canvas = document.createElement("canvas")
  canvas.style.cssText = style
  return canvas
}

/**
 * Paint a point for each orbit, and return the context.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {DOMRect} box
 * @param {Window} window
 * @param {Orbits} orbits
 * @param {string[]} colours  of the outcomes, exits first
 * @param {Float64Array[]} points  abscissas and ordinates
 * @param {number[]} units  of both, in units of the page
 */
function paint(canvas, box, window, {channel, hasTrails}, colours, [xs, ys], [unitX, unitY]) {
  const context = cover(canvas, box)
  if (!context) return null
  if (hasTrails) {
    context.globalCompositeOperation = "destination-in"
    context.fillStyle = `rgba(0,0,0,${TRAIL_OPACITY})`
    context.fillRect(0, 0, box.width, box.height)
    context.globalCompositeOperation = "source-over"
  } else context.clearRect(0, 0, box.width, box.height)
  // One colour at a time, because changing the colour of a canvas is slow.
  const inks = [getComputedStyle(canvas).color, ...colours]
  inks.forEach((ink, code) => {
    context.fillStyle = ink
    for (let i = 0; i < xs.length; i++) {
      if (channel[i] !== code) continue
      const [left, top] = placeIn(box, window, [xs[i] * unitX, ys[i] * unitY])
      if (left >= 0 && top >= 0 && left < box.width && top < box.height)
        context.fillRect(left - PARTICLE_SIDE / 2, top - PARTICLE_SIDE / 2, PARTICLE_SIDE, PARTICLE_SIDE)
    }
  })
  return context
}

/**
 * Write the numbers of the exits over the particles, which would cover those of the picture.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {DOMRect} box
 * @param {Window} window
 * @param {{channel: number, label: [number, number]}[]} exits
 */
function writeNumbers(context, box, window, exits) {
  const style = getComputedStyle(context.canvas)
  Object.assign(context, {font: LETTERS, textAlign: "center", textBaseline: "middle", lineJoin: "round"})
  context.lineWidth = OUTLINE_WIDTH
  context.strokeStyle = style.getPropertyValue("--ui-page")
  context.fillStyle = style.getPropertyValue("--ui-ink")
  for (const {channel, label} of exits) {
    const [left, top] = placeIn(box, window, label)
    context.strokeText(String(channel), left, top)
    context.fillText(String(channel), left, top)
  }
}
