// @ts-check
/** The picture on the slider of the energy: the shares of the outcomes at each energy, stacked, for the slice and window in view. */

import {contextFor} from "../../../../plots/browser/modules/painting/canvas.js"
import {energyAxis} from "../../../../plots/browser/modules/engine/starts.js"
import {RESTING_HORIZON} from "../../../../plots/browser/modules/workers/frames.js"
import {Shares} from "../../../../plots/browser/modules/workers/shares.js"

/** Largest width of the column of an energy, in pixels of the page. */
const WIDEST_COLUMN = 6

/** Number of known energies from which columns are painted. Fewer would show the shares of one energy at all energies. */
const FEWEST_COLUMNS = 5

export class ShareStrip {
  /**
   * @param {import("../view_store.js").Rail} rail  of the slider
   * @param {import("../../../../plots/browser/modules/workers/frames.js").Frames} frames
   * @param {(energy: number) => import("../../../../plots/browser/modules/workers/frames.js").Scene | null} sceneAt
   */
  constructor({canvas, slider}, frames, sceneAt) {
    this.#canvas = canvas
    this.#slider = slider
    this.#frames = frames
    this.#sceneAt = sceneAt
    new ResizeObserver(() => this.#resize()).observe(canvas)
  }

  #canvas
  #slider
  #frames
  #sceneAt
  /** What the shares belong to, as text. */
  #key = ""
  /** @type {Shares | null} */
  #shares = null
  /** Fates and their colours, from the top of the stack. @type {[number, string][]} */
  #stack = []

  /**
   * Show the shares of a view. Those of another slice, window or system are dropped.
   *
   * @param {import("./preview.js").ServerView} view
   * @param {import("../../../../plots/browser/modules/engine/system.js").System | null} system  of the engine
   */
  follow({system: key, slice, window, energies, stack}, system) {
    const isKnown = slice && energyAxis(slice) < 0 && system?.key === key
    const newKey = isKnown ? JSON.stringify([key, slice, window, energies]) : ""
    this.#stack = stack
    if (newKey !== this.#key) {
      const [low, high] = energies
      this.#key = newKey
      this.#shares = newKey
        ? new Shares(
            place => this.#sceneAt(low + (high - low) * place),
            () => this.#paint(),
          )
        : null
      const time = isKnown ? RESTING_HORIZON * system.units.time : 0
      this.#slider.title = isKnown ? `Shares of a coarse map at t = ${time}; grey: still inside` : ""
      this.#slider.toggleAttribute("data-pictured", !!newKey)
    }
    this.#resize()
  }

  /** Binary logarithm of the number of intervals between the energies. */
  get #levels() {
    return Math.max(Math.ceil(Math.log2(this.#canvas.clientWidth / WIDEST_COLUMN)), 0)
  }

  /** Paint all columns in the present size, and compute those that are missing. */
  #resize() {
    const {clientWidth: width, clientHeight: height} = this.#canvas
    contextFor(this.#canvas, {width, height})?.clearRect(0, 0, width, height)
    this.#paint()
    const shares = this.#shares
    shares?.refine(this.#levels)
    this.#frames.setExtras(() => shares?.next() ?? null)
  }

  /** Paint the column of each known energy, which extends halfway to the next ones. */
  #paint() {
    const context = this.#canvas.getContext("2d")
    const known = [...(this.#shares?.counts ?? [])].sort(([place], [other]) => place - other)
    if (!context || known.length < FEWEST_COLUMNS) return
    context.setTransform(1, 0, 0, 1, 0, 0)
    known.forEach(([place, counts], k) => {
      const [left, right] = [known[k - 1]?.[0] ?? -place, known[k + 1]?.[0] ?? 2 - place].map(other => (place + other) / 2)
      this.#paintColumn(context, left, right, counts)
    })
  }

  /**
   * Paint the stack of an energy between two places.
   *
   * @param {CanvasRenderingContext2D} context
   * @param {number} from
   * @param {number} to
   * @param {import("../../../../plots/browser/modules/workers/shares.js").Counts} counts
   */
  #paintColumn(context, from, to, counts) {
    const {width, height} = this.#canvas
    // Columns that begin and end between two pixels of the screen would leave gaps.
    const [left, right] = [Math.round(from * width), Math.round(to * width)]
    const total = this.#stack.reduce((sum, [fate]) => sum + (counts.get(fate) ?? 0), 0)
    let sum = 0
    for (const [fate, colour] of this.#stack) {
      const top = Math.round((sum / total) * height)
      sum += counts.get(fate) ?? 0
      context.fillStyle = colour
      context.fillRect(left, top, right - left, Math.round((sum / total) * height) - top)
    }
  }
}
