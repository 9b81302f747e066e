// @ts-check
/**
 * Previews computed in the browser while the energy or the window changes. A preview stays until the server's map of the same
 * view is complete or has at least as many pixels.
 */

import {exitLines, LimitingCurves} from "../../../../plots/browser/modules/engine/curves.js"
import {Integrator} from "../../../../plots/browser/modules/engine/integrator.js"
import {energyAxis, isNearWindow, showsPositions, windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {coversEnergy} from "../../../../plots/browser/modules/engine/system.js"
import {pixelColumns, sameEnergy, showsScene} from "../../../../plots/browser/modules/painting/columns.js"
import {Local, LocalWhenPresent} from "../painting/local.js"
import {Outlines} from "../painting/outlines.js"
import {LEAST_SIDE} from "../../../../plots/browser/modules/workers/frames.js"

/**
 * The view as the server describes it.
 *
 * @typedef {object} ServerView
 * @property {string} system  key of the system
 * @property {string} well  key of its potential
 * @property {string} plane  name of the slice
 * @property {import("../../../../plots/browser/modules/engine/system.js").Slice | null} slice  null for a slice that only the server can compute
 * @property {import("../../../../plots/browser/modules/engine/starts.js").Window | null} window  null for the default window of the energy
 * @property {[number, number]} energies  range of the slider
 * @property {string[]} colours  of the outcomes, exits first
 * @property {string[]} labels  of the outcomes
 * @property {[number, string][]} stack  fates of allowed starts and their colours, in the order of a stack of shares
 * @property {number} sharesHorizon  integration time of the shares on the slider, in units of the well
 * @property {import("../../../../plots/browser/modules/painting/columns.js").Coding} coding
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
   * @param {import("../../../../plots/browser/modules/workers/frames.js").Frames} frames
   * @param {import("../painting/overlay.js").Overlay} overlay
   * @param {import("../view_store.js").ViewStore} store
   */
  constructor(find, findSource, frames, overlay, {energy, window}) {
    this.#overlay = overlay
    this.#find = find
    this.#frames = frames
    this.#energy = energy
    this.#window = window
    for (const value of [energy, window]) value.listen(() => this.#follow())
    this.#maps = new Local(find("maps"), ["data"], () => this.#follow())
    this.#outlines = new Outlines(name => findSource("basins", name))
    this.#well = new Outlines(name => findSource("well", name))
    const {x_range: x, y_range: y} = find("well")
    this.#wellRanges = [x, y]
    this.#status = new LocalWhenPresent(() => findByClass("status")?.model, ["text", "css_classes"])
  }

  #find
  #frames
  #overlay
  #energy
  #window
  #maps
  #outlines
  #well
  #wellRanges
  #status
  #mapCurves = new LimitingCurves()
  #wellCurves = new LimitingCurves()
  /** @type {import("../../../../plots/browser/modules/engine/system.js").System | null} */
  #system = null
  /** @type {Integrator | null} */
  #integrator = null
  /** @type {ServerView | null} */
  #view = null
  /** The preview on the page. @type {import("../../../../plots/browser/modules/engine/pixels.js").View | null} */
  #shownView = null

  /**
   * Set the system of the view, or of the next view.
   *
   * @param {import("../../../../plots/browser/modules/engine/system.js").System} system
   * @param {import("../../../../plots/browser/modules/engine/integrator.js").Modules} modules
   */
  setSystem(system, modules) {
    this.#system = system
    this.#integrator = new Integrator(system, modules)
    this.#frames.setSystem(system, modules)
    this.#follow()
  }

  /** @param {ServerView} view */
  setView(view) {
    const viewChanged = this.#view && (view.system !== this.#view.system || view.plane !== this.#view.plane)
    // A preview at a new energy has a window of its own until the server chooses one, which may be the last window from the server.
    const isWindowChosen = this.#view && !this.#view.window && view.window
    this.#view = view
    if (viewChanged) this.#restore()
    if (isWindowChosen) this.#window.follow()
  }

  /** The scene to show; null if the browser cannot compute it. @returns {import("../../../../plots/browser/modules/workers/frames.js").Scene | null} */
  get scene() {
    return this.#sceneIn(this.#sceneWindow, this.#energy.value)
  }

  /**
   * Return the scene of the view at another energy; null if the browser cannot compute it.
   *
   * @param {number} energy
   */
  sceneAt(energy) {
    const [view, integrator] = [this.#view, this.#integrator]
    return this.#sceneIn(view?.window ?? (view && integrator && windowAt(integrator, view.plane, energy)), energy)
  }

  /**
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window | null} window
   * @param {number} energy
   * @returns {import("../../../../plots/browser/modules/workers/frames.js").Scene | null}
   */
  #sceneIn(window, energy) {
    const [view, system] = [this.#view, this.#system]
    if (!view?.slice || !system || view.system !== system.key || !window) return null
    // Without an axis of energy, the index is −1.
    const highest = [window.xHigh, window.ordinateHigh][energyAxis(view.slice)] ?? energy
    if (!coversEnergy(system, highest / system.units.energy)) return null
    return {slice: view.slice, energy, window, mostPixels: view.resolution}
  }

  /** Whether the server has not sent the window of the view yet. */
  get #findsWindow() {
    const [view, shown] = [this.#view, this.#window.value]
    if (!view || view.system !== this.#system?.key) return false
    return !shown || (!view.window && this.#energy.isNewer && !this.#window.isNewer)
  }

  /** The window on the page, or to be shown with the pixels. @returns {import("../../../../plots/browser/modules/engine/starts.js").Window | null} */
  get #sceneWindow() {
    const [view, integrator, shown] = [this.#view, this.#integrator, this.#window.value]
    if (!this.#findsWindow || !view || !integrator) return shown
    if (view.window) return view.window
    const served = this.#window.model.shown.value
    if (served && sameEnergy(this.#energy.value, this.#energy.model.shown.value)) return served
    const window = windowAt(integrator, view.plane, this.#energy.value)
    // Painting axes takes longer than painting pixels, so the window follows only larger changes.
    return window && !(shown && isNearWindow(window, shown)) ? window : shown
  }

  /** Columns of the other view, if the server compares two views pixel by pixel; otherwise null. */
  get #compared() {
    const isCompared = this.#maps.server.data.difference?.[0].length > 1
    return isCompared ? (this.#find("compared_map")?.data ?? null) : null
  }

  /** Show the scene: the map of the server if it shows the scene, otherwise a preview. */
  #follow() {
    const scene = this.scene
    if (!scene) {
      this.#maps.acceptServer()
      return
    }
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
   * @param {import("../../../../plots/browser/modules/engine/pixels.js").View} view
   * @param {import("../../../../plots/browser/modules/engine/pixels.js").Pixels} pixels
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
    // Each change of a range repaints all pictures, so the window changes only together with the pixels.
    if (this.#findsWindow) this.#window.show(view.window)
    // The text of a stopped map stays.
    if (!this.#status.server.css_classes?.includes("stopped")) {
      this.#status.show({text: `Preview up to t = ${view.horizon * system.units.time}`})
    }
    markPreview(true)
    if (isMoving && this.#energy.isUnsent) {
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
    if (well) this.#showWell(well.window, well.limit, coloured)
    this.#overlay.hide()
  }

  /**
   * Return the window and the zero-velocity curve of the well; null on a slice with an axis h, where the well does not change.
   *
   * @param {Integrator} integrator
   * @param {import("../../../../plots/browser/modules/engine/pixels.js").View} view
   */
  #traceWell(integrator, {slice, energy}) {
    const {system} = integrator
    const window = energyAxis(slice) < 0 ? windowAt(integrator, "x_y", energy) : null
    return window && {window, limit: this.#wellCurves.trace(integrator, {slice: system.space, window, energy})}
  }

  /**
   * Show the well in its window.
   *
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window} window
   * @param {import("../painting/outlines.js").Line[]} limit
   * @param {import("../painting/outlines.js").Exit[]} exits
   */
  #showWell(window, limit, exits) {
    this.#well.show(limit, exits)
    const [x, y] = this.#wellRanges
    x.setv({start: window.xLow, end: window.xHigh}, {sync: false})
    y.setv({start: window.ordinateLow, end: window.ordinateHigh}, {sync: false})
  }

  /** Show what the server shows. */
  #restore() {
    this.#frames.stop()
    this.#shownView = null
    this.#overlay.hide()
    markPreview(false)
    for (const local of [this.#maps, this.#outlines, this.#well, this.#status]) local.restore()
    // The range of the reset tool is that of the server, and null before its first map.
    for (const range of this.#wellRanges)
      range.setv({start: range.reset_start ?? range.start, end: range.reset_end ?? range.end}, {sync: false})
    if (this.#window.value !== this.#window.model.shown.value) this.#window.follow()
  }
}

/** Return a view by a CSS class: of the status line or of the grid of maps, which have no names in the document. @param {string} name */
const findByClass = name => [...Bokeh.index.all_views()].find(view => view.model.css_classes?.includes(name))

/** Mark the maps as a preview, which belongs to the controls also before the server's map of a new system. @param {boolean} on */
const markPreview = on => findByClass("maps")?.el.toggleAttribute("data-preview", on)

/**
 * Return the scene of a view.
 *
 * @param {import("../../../../plots/browser/modules/engine/pixels.js").View} view
 * @returns {import("../../../../plots/browser/modules/workers/frames.js").Scene}
 */
const sceneOf = ({slice, energy, window, mostPixels}) => ({slice, energy, window, mostPixels})
