// @ts-check
/** The picture on the slider of the energy: the shares of the outcomes at each energy, stacked, for the slice and window in view. */

import {energyAxis} from "../../../../plots/browser/modules/engine/starts.js"
import {paintShares} from "../painting/share_columns.js"
import {Shares} from "../../../../plots/browser/modules/workers/shares.js"

/** Largest width of the column of an energy, in pixels of the page. */
const WIDEST_COLUMN = 6

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
  follow({system: key, slice, window, energies, stack, sharesHorizon}, system) {
    const isKnown = slice && energyAxis(slice) < 0 && system?.key === key
    const newKey = isKnown ? JSON.stringify([key, slice, window, energies]) : ""
    this.#stack = stack
    if (newKey !== this.#key) {
      const [low, high] = energies
      this.#key = newKey
      this.#shares = newKey
        ? new Shares(
            place => this.#sceneAt(low + (high - low) * place),
            sharesHorizon,
            () => this.#paint(),
          )
        : null
      const time = isKnown ? sharesHorizon * system.units.time : 0
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
    this.#paint()
    const shares = this.#shares
    shares?.refine(this.#levels)
    this.#frames.setExtras(() => shares?.next() ?? null)
  }

  #paint() {
    const stackOf = (/** @type {import("../../../../plots/browser/modules/workers/shares.js").Counts} */ counts) =>
      this.#stack.map(([fate, colour]) => /** @type {[string, number]} */ ([colour, counts.get(fate) ?? 0]))
    const columns = [...(this.#shares?.counts ?? [])]
    paintShares(
      this.#canvas,
      columns.map(([place, counts]) => [place, stackOf(counts)]),
    )
  }
}
