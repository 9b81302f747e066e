// @ts-check
/** Points of many orbits on a canvas, with the colours of the chart in `plots/studies/section.py`. */

/** Side of a dot, in pixels. */
const SIDE = 2

/**
 * The colours of points.
 *
 * @typedef {object} Colouring
 * @property {string} choice  what a colour shows: "orbit", "fate" or "density"
 * @property {string[]} orbits  colours of the orbits, in turn
 * @property {string} inside  colour of orbits that have not ended
 * @property {string[]} ends  colours of the outcomes
 * @property {number[]} densities  least number of points in a cell of each class, rising
 * @property {string[]} classes  colours of the classes
 * @property {number} cells  number of cells along a side of the window
 */

/** @typedef {{left: number, top: number, state: number[]}} Dot */

export class Dots {
  /**
   * @param {CanvasRenderingContext2D} context
   * @param {{width: number, height: number}} box  the frame that the window fills, in pixels
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window} window
   * @param {Colouring} colouring
   */
  constructor(context, box, window, colouring) {
    this.#context = context
    this.#box = box
    this.#window = window
    this.#colouring = colouring
  }

  #context
  #box
  #window
  #colouring
  /** The dots of each orbit, or of each cell. @type {Map<number | string, Dot[]>} */
  #groups = new Map()

  /**
   * Paint a point.
   *
   * @param {number} orbit
   * @param {[number, number]} place
   * @param {number[]} state  of the orbit at the point
   */
  add(orbit, [x, ordinate], state) {
    const [{width, height}, window] = [this.#box, this.#window]
    const shareX = (x - window.xLow) / (window.xHigh - window.xLow)
    const shareY = (window.ordinateHigh - ordinate) / (window.ordinateHigh - window.ordinateLow)
    const dot = {left: shareX * width, top: shareY * height, state}
    const {choice, orbits, inside, cells, densities, classes} = this.#colouring
    const key = choice === "density" ? `${Math.floor(shareX * cells)} ${Math.floor(shareY * cells)}` : orbit
    const group = this.#groups.get(key) ?? []
    group.push(dot)
    this.#groups.set(key, group)
    if (choice !== "density") {
      this.#paint([dot], choice === "fate" ? inside : orbits[orbit % orbits.length])
      return
    }
    const index = densities.findLastIndex(least => least <= group.length)
    // With the first point of a class, all points of the cell change their colour.
    this.#paint(densities[index] === group.length ? group : [dot], classes[index])
  }

  /**
   * Paint the points of an orbit that has ended.
   *
   * @param {number} orbit
   * @param {number} channel  number of the outcome
   */
  end(orbit, channel) {
    const {choice, ends} = this.#colouring
    if (choice === "fate") this.#paint(this.#groups.get(orbit) ?? [], ends[channel - 1])
  }

  /** Return the state at the point nearest to a place on the canvas; null without points. @param {number} left @param {number} top */
  nearest(left, top) {
    const distance = (/** @type {Dot} */ dot) => Math.hypot(dot.left - left, dot.top - top)
    /** @type {Dot | null} */
    let nearest = null
    for (const group of this.#groups.values())
      for (const dot of group) if (!nearest || distance(dot) < distance(nearest)) nearest = dot
    return nearest?.state ?? null
  }

  /** @param {Dot[]} dots @param {string} colour */
  #paint(dots, colour) {
    this.#context.fillStyle = colour
    for (const {left, top} of dots) this.#context.fillRect(left - SIDE / 2, top - SIDE / 2, SIDE, SIDE)
  }
}
