// @ts-check
/**
 * Previews computed in the browser while the energy or the window changes. A preview stays until the server's map of the same
 * view is complete or has at least as many pixels.
 */

import {dispatch} from "../energy_events.js"
import {exitLines, LimitingCurves} from "../engine/curves.js"
import {Integrator} from "../engine/integrator.js"
import {energyAxis, isNearWindow, showsPositions, windowAt} from "../engine/starts.js"
import {coversEnergy} from "../engine/system.js"
import {pixelColumns, sameEnergy, showsScene} from "../painting/columns.js"
import {Local, LocalWhenPresent} from "../painting/local.js"
import {Outlines} from "../painting/outlines.js"
import {LEAST_SIDE} from "../workers/frames.js"

/**
 * The view as the server describes it.
 *
 * @typedef {object} ServerView
 * @property {string} system  key of the system
 * @property {string} plane  name of the slice
 * @property {import("../engine/system.js").Slice | null} slice  null for a slice that only the server can compute
 * @property {number} energy
 * @property {boolean} home  whether the window is the default window of its energy
 * @property {string[]} colours  of the outcomes, exits first
 * @property {string[]} labels  of the outcomes
 * @property {import("../painting/columns.js").Coding} coding
 * @property {number} resolution  pixels along a side of the server's map
 */

/**
 * Finds a model of Bokeh by name; null if it is not on the page.
 *
 * @typedef {(name: string) => any} FindModel
 */

export class Preview {
  /**
   * @param {FindModel} find
   * @param {(picture: string, name: string) => any} findSource  finds a data source of a picture
   * @param {import("../workers/frames.js").Frames} frames
   * @param {import("../painting/overlay.js").Overlay} overlay
   */
  constructor(find, findSource, frames, overlay) {
    this.#overlay = overlay
    this.#find = find
    const ranges = find("basins")
    this.#frames = frames
    this.#maps = new Local(find("maps"), ["data"], () => this.#follow())
    const onMove = () => this.#followRange()
    this.#xRange = new Local(ranges.x_range, ["start", "end"], onMove)
    this.#yRange = new Local(ranges.y_range, ["start", "end"], onMove)
    this.#ranges = () => [ranges.x_range, ranges.y_range]
    this.#outlines = new Outlines(name => findSource("basins", name))
    this.#well = new Outlines(name => findSource("well", name))
    this.#status = new LocalWhenPresent(findStatus, ["text", "css_classes"])
  }

  #find
  #frames
  #overlay
  #maps
  #xRange
  #yRange
  #ranges
  #outlines
  #well
  #status
  #mapCurves = new LimitingCurves()
  #wellCurves = new LimitingCurves()
  /** @type {import("../engine/system.js").System | null} */
  #system = null
  /** @type {Integrator | null} */
  #integrator = null
  /** @type {ServerView | null} */
  #view = null
  /** Energy of the slider or of the player, until the server has received it. @type {number | null} */
  #energy = null
  /**
   * Default window at the energy, which is shown together with its pixels; null if the ranges keep their window.
   *
   * @type {import("../engine/starts.js").Window | null}
   */
  #defaultWindow = null
  /** Whether the energy is being dragged or played. */
  #isHeld = false
  /** Whether a call of `#follow` waits for the end of the task. */
  #followsSoon = false
  /** The preview on the page. @type {import("../engine/pixels.js").View | null} */
  #shownView = null

  /**
   * Set the system of the view, or of the next view.
   *
   * @param {import("../engine/system.js").System} system
   * @param {import("../engine/integrator.js").Modules} modules
   */
  setSystem(system, modules) {
    this.#system = system
    this.#integrator = new Integrator(system, modules)
    this.#frames.setSystem(system, modules)
    if (this.#isHeld && this.#energy !== null) this.showEnergy(this.#energy)
    else this.#follow()
  }

  /** @param {ServerView} view */
  setView(view) {
    const viewChanged = this.#view && (view.system !== this.#view.system || view.plane !== this.#view.plane)
    this.#view = view
    if (!this.#isHeld) this.#energy = this.#defaultWindow = null
    if (viewChanged) this.#restore()
  }

  /**
   * Show another energy until `release`.
   *
   * @param {number} energy
   */
  showEnergy(energy) {
    this.#isHeld = true
    this.#energy = energy
    const [view, integrator] = [this.#view, this.#integrator]
    const followsDefault = view?.home && view.system === integrator?.system.key
    const isServerEnergy = view && sameEnergy(energy, view.energy)
    const defaultWindow = followsDefault && integrator && !isServerEnergy ? windowAt(integrator, view.plane, energy) : null
    // Painting axes takes longer than painting pixels, so the window follows only larger changes.
    if (!defaultWindow || !isNearWindow(defaultWindow, this.#currentWindow)) this.#defaultWindow = defaultWindow
    if (isServerEnergy) for (const range of [this.#xRange, this.#yRange]) range.restore()
    this.#follow()
  }

  /** End the preview of an energy, which the server receives now. */
  release() {
    this.#isHeld = false
  }

  /** The scene to show; null if the browser cannot compute it. @returns {import("../workers/frames.js").Scene | null} */
  get scene() {
    const [view, system, window] = [this.#view, this.#system, this.#currentWindow]
    if (!view?.slice || !system || view.system !== system.key) return null
    if (!(window.xLow < window.xHigh && window.ordinateLow < window.ordinateHigh)) return null
    const energy = this.#energy ?? view.energy
    // Without an axis of energy, the index is −1.
    const highest = [window.xHigh, window.ordinateHigh][energyAxis(view.slice)] ?? energy
    if (!coversEnergy(system, highest / system.units.energy)) return null
    return {slice: view.slice, energy, window, mostPixels: view.resolution}
  }

  /** The window on the page, or about to be shown. @returns {import("../engine/starts.js").Window} */
  get #currentWindow() {
    const [x, y] = this.#ranges()
    return this.#defaultWindow ?? {xLow: x.start, xHigh: x.end, ordinateLow: y.start, ordinateHigh: y.end}
  }

  /** Columns of the other view, if the server compares two views pixel by pixel; otherwise null. */
  get #compared() {
    const isCompared = this.#maps.server.data.difference?.[0].length > 1
    return isCompared ? (this.#find("compared_map")?.data ?? null) : null
  }

  /** Follow a change of a range after the other changes of the same task: of its other end, and of the server's pixels. */
  #followRange() {
    if (this.#followsSoon) return
    this.#followsSoon = true
    queueMicrotask(() => {
      this.#followsSoon = false
      this.#follow()
    })
  }

  /** Show the scene: the map of the server if it shows the scene, otherwise a preview. */
  #follow() {
    const scene = this.scene
    if (!scene) {
      this.#maps.acceptServer()
      return
    }
    dispatch("sceneshown", scene.energy)
    const isSameScene = this.#shownView && JSON.stringify(scene) === JSON.stringify(sceneOf(this.#shownView))
    const rows = isSameScene && this.#shownView ? this.#shownView.rows : LEAST_SIDE
    if (showsScene(this.#maps.server.data, scene, rows)) {
      this.#restore()
      return
    }
    this.#maps.keepPreview()
    if (!isSameScene) this.#frames.request(scene)
  }

  /**
   * Show a preview: in Bokeh's pictures, or while the energy moves, on canvases over these pictures.
   *
   * @param {import("../engine/pixels.js").View} view
   * @param {import("../engine/pixels.js").Pixels} pixels
   * @param {boolean} isMoving  whether another preview may follow in the next frame
   */
  show(view, pixels, isMoving) {
    const [integrator, server] = [this.#integrator, this.#view]
    if (!integrator || !server) return
    const {system} = integrator
    this.#shownView = view
    const columns = pixelColumns(server.coding, view, pixels, this.#maps.server.data, this.#compared)
    const limit = this.#mapCurves.trace(integrator, view)
    const coloured = exitLines(integrator, view.energy).map(exit => ({...exit, colour: server.colours[exit.channel - 1]}))
    const exits = showsPositions(view.slice) ? coloured : []
    const well = this.#traceWell(integrator, view)
    // Each change of a range repaints all pictures, so ranges change only together with the pixels.
    if (this.#defaultWindow) {
      this.#xRange.show({start: view.window.xLow, end: view.window.xHigh})
      this.#yRange.show({start: view.window.ordinateLow, end: view.window.ordinateHigh})
    }
    // The text of a stopped map stays.
    if (!this.#status.server.css_classes?.includes("stopped")) {
      this.#status.show({text: `Preview up to t = ${view.horizon * system.units.time}`})
    }
    if (isMoving && this.#isHeld) {
      this.#overlay.show({
        energy: view.energy,
        window: view.window,
        columns,
        lines: {zero_velocity_curve: limit, lyapunov_orbits: exits},
        well: well && {window: well.window, lines: {zero_velocity_curve: well.limit, lyapunov_orbits: coloured}},
      })
      return
    }
    this.#maps.show({data: columns})
    this.#outlines.show(limit, exits)
    if (well) this.#well.show(well.limit, coloured)
    this.#overlay.hide()
  }

  /**
   * Return the window and the zero-velocity curve of the well; null on a slice with an axis h, where the well does not change.
   *
   * @param {Integrator} integrator
   * @param {import("../engine/pixels.js").View} view
   */
  #traceWell(integrator, {slice, energy}) {
    const {system} = integrator
    const window = energyAxis(slice) < 0 ? windowAt(integrator, "x_y", energy) : null
    return window && {window, limit: this.#wellCurves.trace(integrator, {slice: system.space, window, energy})}
  }

  /** Show what the server shows. */
  #restore() {
    this.#frames.stop()
    this.#shownView = null
    this.#overlay.hide()
    for (const local of [this.#maps, this.#outlines, this.#well, this.#status, this.#xRange, this.#yRange]) local.restore()
  }
}

/** The status line, which has no name in the document. */
const findStatus = () => [...Bokeh.index.all_views()].find(view => view.model.css_classes?.includes("status"))?.model

/**
 * Return the scene of a view.
 *
 * @param {import("../engine/pixels.js").View} view
 * @returns {import("../workers/frames.js").Scene}
 */
const sceneOf = ({slice, energy, window, mostPixels}) => ({slice, energy, window, mostPixels})
