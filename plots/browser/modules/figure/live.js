// @ts-check
/**
 * A live figure: a map in a file, which the browser computes again while the visitor changes energy and window.
 *
 * @typedef {import("../engine/pixels.js").View} View
 * @typedef {import("../engine/pixels.js").Pixels} Pixels
 */

import {Integrator} from "../engine/integrator.js"
import {findPath} from "../engine/path.js"
import {energyAxis, windowAt} from "../engine/starts.js"
import {coversEnergy} from "../engine/system.js"
import {EnergyPlayer} from "../gestures/player.js"
import {number} from "../numbers.js"
import {describeOutcome} from "../painting/orbit_drawing.js"
import {Frames} from "../workers/frames.js"
import {Pool, workerCount} from "../workers/pool.js"
import {hasVectors} from "../workers/vectors.js"
import {bytesOf} from "./data.js"
import {connectGestures} from "./gestures.js"
import {MapPicture, WellPicture} from "./pictures.js"

/** Largest number of pixels along a side of a preview. */
const MOST_PIXELS = 448
/** Smallest share of the side of the first window, below which numbers have too few digits. */
const SMALLEST_SHARE = 1e-10

/** Return the element of a live figure with a name. @type {(id: string) => any} */
const part = id => document.getElementById(id)

class LiveFigure {
  /**
   * @param {import("./data.js").FigureData} data
   * @param {import("../engine/integrator.js").Modules} modules
   * @param {Record<string, HTMLImageElement>} images  exact pixels of the pictures
   * @param {string} program  of the workers
   */
  constructor(data, modules, images, program) {
    this.#data = data
    this.#integrator = new Integrator(data.system, modules)
    this.#exact = {window: data.window, exact: images, columns: null}
    this.#shown = this.#exact
    this.#energy = data.energy
    this.#window = data.window
    this.#isHome = data.home
    this.#picture = data.pictures[0]
    this.#starts = [...data.starts]
    this.#map = new MapPicture(part("map"), data, this.#integrator)
    this.#well = new WellPicture(part("well"), data, this.#integrator)
    const worker = URL.createObjectURL(new Blob([program], {type: "text/javascript"}))
    const pool = new Pool(() => new Worker(worker))
    const show = (/** @type {View} */ view, /** @type {Pixels} */ pixels, /** @type {boolean} */ isMoving) =>
      this.#receive(view, pixels, isMoving)
    this.#frames = new Frames(pool, workerCount(), show, data.horizon / data.system.units.time)
    this.#frames.setSystem(data.system, modules)
    this.#player = new EnergyPlayer(
      energy => this.#setEnergy(energy),
      () => this.#showPlaying(false),
    )
    this.#connect()
    this.#showStatus(data.exact)
    this.#paint()
    this.#listOrbits()
  }

  #data
  #integrator
  #frames
  #player
  #map
  #well
  #exact
  /** @type {import("./pictures.js").Shown} */
  #shown
  #energy
  #window
  #isHome
  #picture
  /** @type {[number, number][]} */
  #starts
  /** The start under the pointer. @type {[number, number] | null} */
  #pointed = null
  #isPainting = false

  #connect() {
    connectGestures(part("map"), () => this.#map.frame, {
      point: place => this.#point(place && this.#pointAt(place)),
      choose: place => this.#choose(this.#pointAt(place)),
      move: shares => this.#moveWindow(shares),
      zoom: (factor, place) => this.#zoom(factor, place),
      reset: () => this.#reset(),
    })
    const slider = part("energy")
    slider.addEventListener("input", () => {
      this.#player.stop()
      this.#setEnergy(Number(slider.value))
    })
    part("play").addEventListener("click", () => {
      if (this.#player.playing) this.#player.stop()
      else {
        this.#showPlaying(true)
        this.#player.start(this.#energy, this.#data.low, this.#data.high)
      }
    })
    part("home").addEventListener("click", () => this.#reset())
    part("clear").addEventListener("click", () => {
      this.#starts = []
      this.#listOrbits()
      this.#paint()
    })
    part("picture").addEventListener("change", () => this.#setPicture(part("picture").value))
    addEventListener("resize", () => this.#paint())
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#paint())
    // A print does not wait for a frame of the screen.
    matchMedia("print").addEventListener("change", () => this.#draw())
  }

  /** @param {string} name */
  #setPicture(name) {
    this.#picture = this.#data.pictures.find(picture => picture.name === name) ?? this.#picture
    for (const legend of document.querySelectorAll("[data-picture]")) {
      if (legend instanceof HTMLElement) legend.hidden = legend.dataset.picture !== this.#picture.name
    }
    this.#paint()
  }

  /** @param {number} energy */
  #setEnergy(energy) {
    this.#energy = energy
    if (this.#isHome) this.#window = this.#homeWindow()
    part("energy").value = String(energy)
    part("shown-energy").textContent = energy.toFixed(this.#data.decimals).replace("-", "−")
    this.#request()
    this.#listOrbits()
  }

  /** The default window of the energy, or the present window beyond its table. */
  #homeWindow() {
    const {plane, energy, home, window} = this.#data
    if (this.#energy === energy && home) return window
    return windowAt(this.#integrator, plane, this.#energy) ?? this.#window
  }

  /** @param {import("../engine/starts.js").Window} window */
  #setWindow(window) {
    this.#window = window
    this.#isHome = false
    this.#request()
  }

  /** Show the energy and the window of the file. */
  #reset() {
    this.#player.stop()
    this.#window = this.#data.window
    this.#isHome = this.#data.home
    this.#setEnergy(this.#data.energy)
  }

  /** @param {[number, number]} shares */
  #moveWindow([right, up]) {
    const {xLow, xHigh, ordinateLow, ordinateHigh} = this.#window
    const [x, y] = [-right * (xHigh - xLow), -up * (ordinateHigh - ordinateLow)]
    this.#setWindow({xLow: xLow + x, xHigh: xHigh + x, ordinateLow: ordinateLow + y, ordinateHigh: ordinateHigh + y})
  }

  /**
   * @param {number} factor
   * @param {[number, number]} place
   */
  #zoom(factor, place) {
    const {xLow, xHigh, ordinateLow, ordinateHigh} = this.#window
    const first = this.#data.window
    if (factor < 1 && xHigh - xLow < SMALLEST_SHARE * (first.xHigh - first.xLow)) return
    const [x, y] = this.#pointAt(place)
    this.#setWindow({
      xLow: x - factor * (x - xLow),
      xHigh: x + factor * (xHigh - x),
      ordinateLow: y - factor * (y - ordinateLow),
      ordinateHigh: y + factor * (ordinateHigh - y),
    })
  }

  /** Return the point of the slice at a place of the picture. @param {[number, number]} place @returns {[number, number]} */
  #pointAt([right, up]) {
    const {xLow, xHigh, ordinateLow, ordinateHigh} = this.#window
    return [xLow + right * (xHigh - xLow), ordinateLow + up * (ordinateHigh - ordinateLow)]
  }

  /** Show the exact map, or compute a preview. */
  #request() {
    const {slice, energy, window, system, exact} = this.#data
    if (this.#energy === energy && JSON.stringify(this.#window) === JSON.stringify(window)) {
      this.#frames.stop()
      this.#shown = this.#exact
      this.#showStatus(exact)
    } else {
      const highest = [this.#window.xHigh, this.#window.ordinateHigh][energyAxis(slice)] ?? this.#energy
      if (coversEnergy(system, highest / system.units.energy)) {
        this.#frames.request({slice, energy: this.#energy, window: this.#window, mostPixels: MOST_PIXELS})
        if (this.#shown === this.#exact) this.#showStatus("A preview is computed here.")
      } else this.#showStatus("The exits are not in this file for energies as high.")
    }
    this.#paint()
  }

  /**
   * @param {View} view
   * @param {Pixels} pixels
   * @param {boolean} isMoving  whether another preview may follow in the next frame
   */
  #receive(view, pixels, isMoving) {
    this.#shown = this.#map.preview(view, pixels)
    const horizon = number(view.horizon * this.#integrator.system.units.time)
    // A screen reader would read every change of the sentence.
    const details = isMoving ? "" : `: ${view.columns} × ${view.rows} pixels, up to t = ${horizon}`
    this.#showStatus(`Preview, computed here${details}.`)
    this.#paint()
  }

  /** Paint both pictures before the next repaint of the screen. */
  #paint() {
    if (this.#isPainting) return
    this.#isPainting = true
    requestAnimationFrame(() => {
      this.#isPainting = false
      this.#draw()
    })
  }

  /** Draw both pictures. */
  #draw() {
    this.#map.draw(this.#window, this.#energy, this.#picture, this.#shown, this.#starts)
    const start = this.#pointed ?? this.#starts[this.#starts.length - 1]
    const path = start ? this.#pathFrom(start) : null
    // On a slice with an axis h, each orbit has its own energy.
    const energy = path ? path.energy * this.#data.system.units.energy : this.#energy
    const outcome = this.#well.draw(energy, path)
    part("well").setAttribute("aria-label", outcome || "The well: limiting curve and exits")
  }

  /** Return the orbit from a point of the slice; null for a point without an orbit. @param {[number, number]} start */
  #pathFrom([x, ordinate]) {
    const {slice, system, longest} = this.#data
    const point = /** @type {[number, number]} */ ([x / slice.units[0], ordinate / slice.units[1]])
    const {energy, time} = system.units
    return findPath(this.#integrator, slice, this.#energy / energy, point, longest / time)
  }

  /** @param {[number, number] | null} point */
  #point(point) {
    this.#pointed = point
    this.#paint()
  }

  /** Add an orbit to the list; the first one goes if there are too many. @param {[number, number]} point */
  #choose(point) {
    if (!this.#pathFrom(point)) return
    this.#starts = [...this.#starts, point].slice(-this.#data.orbits.length)
    this.#listOrbits()
    this.#paint()
  }

  /** List the chosen orbits at the present energy. */
  #listOrbits() {
    const {labels, axes, system} = this.#data
    part("orbits").hidden = this.#starts.length === 0
    const rows = this.#starts.map((start, index) => {
      const path = this.#pathFrom(start)
      // On a narrow screen, the two numbers of a start stand one below the other.
      const place = start.map(value => String(Number(value.toPrecision(10)))).join(", ")
      return [String(index + 1), place, path ? describeOutcome(path, system.units.time, labels) : "No orbit"]
    })
    part("orbit-rows").replaceChildren(...rows.map(row))
    part("orbit-axes").replaceChildren(...["orbit", axes.join(", "), "outcome"].map(text => cell("th", text)))
  }

  /** @param {boolean} isPlaying */
  #showPlaying(isPlaying) {
    part("play").textContent = isPlaying ? "Stop" : "Play"
  }

  /** @param {string} sentence */
  #showStatus(sentence) {
    if (part("status").textContent !== sentence) part("status").textContent = sentence
  }
}

/** @param {string[]} texts */
function row(texts) {
  const element = document.createElement("tr")
  element.append(...texts.map(text => cell("td", text)))
  return element
}

/**
 * @param {string} name
 * @param {string} text
 */
function cell(name, text) {
  const element = document.createElement(name)
  element.textContent = text
  return element
}

/** Return an image when it can be drawn. @param {string} address */
async function imageFrom(address) {
  const image = new Image()
  image.src = address
  await image.decode()
  return image
}

/**
 * Replace the still picture of the page by the live figure, if the browser can run the kernels.
 *
 * @param {{kernels: string, worker: string}} code  WebAssembly of the kernels, in base64, and the program of the workers
 */
export async function start({kernels, worker}) {
  if (!hasVectors()) return
  /** @type {import("./data.js").FigureData} */
  const data = JSON.parse(part("data").textContent)
  const compiled = await Promise.all([kernels, data.module].map(text => WebAssembly.compile(bytesOf(text))))
  const images = await Promise.all(data.pictures.map(async ({name, image}) => [name, await imageFrom(image)]))
  part("live").hidden = false
  part("still").hidden = true
  new LiveFigure(data, {kernels: compiled[0], system: compiled[1]}, Object.fromEntries(images), worker)
}
