// @ts-check
/**
 * Pictures at the rate of the display. While the view moves, a picture has as many pixels as can be computed in a frame of the
 * display. At rest, it has more pixels and a longer time. Only the newest view is computed, but a picture begun while the view
 * moves is finished first: otherwise, fast moves would show no pictures.
 *
 * A figure without a server has no other map of the view. There, pictures at rest are computed again for twice the time, until no
 * pixel is undecided or the longest time is reached.
 *
 * Afterwards, views that the page does not show are computed, one after the other, until a scene is requested.
 *
 * @typedef {import("../engine/pixels.js").View} View
 * @typedef {import("../engine/pixels.js").Pixels} Pixels
 * @typedef {Omit<View, "columns" | "rows" | "horizon">} Scene  slice, energy and window to draw
 *
 * A view that the page does not show, and a function that takes its pixels.
 *
 * @typedef {{view: View, receive: (pixels: Pixels) => void}} Extra
 */

/** Smallest number of pixels along a side, while the view moves. */
export const LEAST_SIDE = 48
/** Longest time while the view moves, in units of the well. */
const MOVING_HORIZON = 30
/** Longest time at rest, in units of the well. */
const RESTING_HORIZON = 100
/** Pixels along a side of the pictures at rest. */
const RESTING_SIDES = [112, 224]
/** Time for computing pixels in a frame of the display, in ms. The rest of the frame is for painting. */
const FRAME_MS = 10
/** Smallest factor of the side from one frame to the next. */
const LEAST_CHANGE = 0.8
/** Largest factor of the side from one frame to the next. */
const LARGEST_CHANGE = 1.25
/** Time without change after which a view is at rest, in ms. */
const REST_MS = 60
/** Number of pixels of a part of a picture at rest; small, because a new view waits until the workers finish their parts. */
const PART_PIXELS = 500

export class Frames {
  /**
   * @param {import("./pool.js").Pool} pool
   * @param {number} workerCount  number of workers of the pool
   * @param {(view: View, pixels: Pixels, isMoving: boolean) => void} show
   * @param {number} longest  longest time of pictures at rest, in units of the well; 0 for `RESTING_HORIZON`
   */
  constructor(pool, workerCount, show, longest = 0) {
    this.#pool = pool
    this.#workerCount = workerCount
    this.#show = show
    this.#longest = longest
  }

  #pool
  #workerCount
  #show
  #longest
  /** @type {import("../engine/system.js").System | null} */
  #system = null
  /** The scene to compute next. @type {Scene | null} */
  #scene = null
  /** @type {"nothing" | "moving" | "resting" | "extra"} */
  #computing = "nothing"
  /** @type {() => Extra | null} */
  #nextExtra = () => null
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #restTimer
  #side = LEAST_SIDE
  #largestSide = RESTING_SIDES[RESTING_SIDES.length - 1]

  /**
   * @param {import("../engine/system.js").System} system
   * @param {import("../engine/integrator.js").Modules} modules
   */
  setSystem(system, modules) {
    this.stop()
    this.#system = system
    this.#pool.setSystem(system, modules)
  }

  /**
   * Compute a view, at once or after the picture of an earlier view.
   *
   * @param {Scene} scene
   */
  request(scene) {
    this.#scene = scene
    clearTimeout(this.#restTimer)
    if (this.#computing !== "moving") this.#begin()
  }

  /** Stop computing pictures. */
  stop() {
    clearTimeout(this.#restTimer)
    this.#scene = null
    this.#computing = "nothing"
    this.#pool.cancel()
    this.#restTimer = setTimeout(() => this.#computeExtra(), REST_MS)
  }

  /**
   * Compute other views while no scene is to be computed.
   *
   * @param {() => Extra | null} next  returns the first of these views that is not computed; null if there is none
   */
  setExtras(next) {
    this.#nextExtra = next
    if (this.#computing === "extra" || this.#computing === "nothing") this.stop()
  }

  /** Compute a picture of the newest view, with as many pixels as can be computed in a frame. */
  #begin() {
    const scene = this.#scene
    this.#scene = null
    if (!scene) return
    this.#computing = "moving"
    const side = Math.min(this.#side, scene.mostPixels)
    const startTime = performance.now()
    // With two parts for each worker, workers that finish early take another part.
    const view = {...scene, columns: side, rows: side, horizon: MOVING_HORIZON}
    this.#compute(view, 2 * this.#workerCount, pixels => {
      this.#show(view, pixels, true)
      // The time for a picture is proportional to the square of the side. Browsers round times, so a difference may be 0.
      const change = Math.sqrt(FRAME_MS / Math.max(performance.now() - startTime, 1))
      const nextSide = Math.round(side * Math.min(Math.max(change, LEAST_CHANGE), LARGEST_CHANGE))
      this.#side = Math.min(Math.max(nextSide, LEAST_SIDE), this.#largestSide)
      this.#computing = "resting"
      if (this.#scene) this.#begin()
      else this.#restTimer = setTimeout(() => this.#refine(scene, 0), REST_MS)
    })
  }

  /**
   * Compute a picture of a view at rest, then the next, finer one.
   *
   * @param {Scene} scene
   * @param {number} level  index in `RESTING_SIDES`
   */
  #refine(scene, level) {
    if (level === RESTING_SIDES.length) {
      this.#computeExtra()
      return
    }
    const side = Math.min(RESTING_SIDES[level], scene.mostPixels)
    // The picture on the page is finer already.
    if (side < this.#side) {
      this.#refine(scene, level + 1)
      return
    }
    const view = {...scene, columns: side, rows: side, horizon: RESTING_HORIZON}
    const isLast = level === RESTING_SIDES.length - 1
    this.#computeResting(view, pixels => (isLast ? this.#lengthen(view, pixels) : this.#refine(scene, level + 1)))
  }

  /**
   * Compute a picture of a view at rest again for twice the time, if that can decide pixels.
   *
   * @param {View} view
   * @param {Pixels} pixels
   */
  #lengthen(view, {fate}) {
    const horizon = Math.min(2 * view.horizon, this.#longest)
    if (horizon > view.horizon && this.#system && fate.includes(this.#system.layout.fates.notComputed)) {
      const longer = {...view, horizon}
      this.#computeResting(longer, pixels => this.#lengthen(longer, pixels))
    } else this.#computeExtra()
  }

  /**
   * Compute and show a picture of a view at rest.
   *
   * @param {View} view
   * @param {(pixels: Pixels) => void} onDone
   */
  #computeResting(view, onDone) {
    this.#computing = "resting"
    this.#compute(view, partsAtRest(view), pixels => {
      this.#show(view, pixels, false)
      onDone(pixels)
    })
  }

  /** Compute the views that the page does not show. */
  #computeExtra() {
    this.#computing = "nothing"
    const extra = this.#system && this.#nextExtra()
    if (!extra) return
    this.#computing = "extra"
    this.#compute(extra.view, partsAtRest(extra.view), pixels => {
      extra.receive(pixels)
      this.#computeExtra()
    })
  }

  /**
   * Compute a picture.
   *
   * @param {View} view
   * @param {number} count  number of parts into which the rows are divided
   * @param {(pixels: Pixels) => void} receive
   */
  #compute(view, count, receive) {
    if (!this.#system) return
    const collector = new PixelCollector(this.#system, view)
    const parts = collector.divide(count)
    let missingParts = parts.length
    this.#pool.compute(view, parts, (part, pixels) => {
      collector.add(part, pixels)
      if (--missingParts === 0) receive(collector.finish())
    })
  }
}

/** Return the number of parts of a picture at rest. @param {View} view */
const partsAtRest = ({columns, rows}) => Math.ceil((columns * rows) / PART_PIXELS)

/** Collects the pixels of a view. In a symmetric view, only one of two mirror images is computed. */
export class PixelCollector {
  /**
   * @param {import("../engine/system.js").System} system
   * @param {View} view
   */
  constructor(system, view) {
    const {columns, rows} = view
    this.#view = view
    this.#mirror = system.mirror ?? []
    this.#flips = mirroredAxes(system, view.slice, view.window)
    const count = columns * rows
    /** @type {Pixels} */
    this.pixels = {
      fate: new Int8Array(count),
      time: new Float32Array(count).fill(NaN),
      crossings: new Uint16Array(count),
    }
  }

  #view
  #mirror
  #flips

  /**
   * Divide the pixels to compute into parts of interleaved rows, which take about the same time.
   *
   * @param {number} count  largest number of parts
   * @returns {import("../engine/pixels.js").Part[]}
   */
  divide(count) {
    const {columns, rows} = this.#view
    const half = (/** @type {number} */ side) => Math.ceil(side / 2)
    const computedRows = this.#flips?.[1] ? half(rows) : rows
    const computedColumns = this.#flips && !this.#flips[1] ? half(columns) : columns
    const parts = Math.min(count, computedRows)
    return Array.from({length: parts}, (_, first) => ({
      rows: Uint32Array.from({length: Math.ceil((computedRows - first) / parts)}, (_, k) => first + k * parts),
      columns: computedColumns,
    }))
  }

  /**
   * Add the pixels of a part.
   *
   * @param {import("../engine/pixels.js").Part} part
   * @param {Pixels} computed
   */
  add(part, computed) {
    const {fate, time, crossings} = this.pixels
    part.rows.forEach((row, index) => {
      const [from, to] = [index * part.columns, row * this.#view.columns]
      fate.set(computed.fate.subarray(from, from + part.columns), to)
      time.set(computed.time.subarray(from, from + part.columns), to)
      crossings.set(computed.crossings.subarray(from, from + part.columns), to)
    })
  }

  /**
   * Return all pixels, with mirror images in place of the pixels that were not computed.
   *
   * @returns {Pixels}
   */
  finish() {
    const flips = this.#flips
    if (!flips) return this.pixels
    const {columns, rows} = this.#view
    const {fate, time, crossings} = this.pixels
    for (let row = flips[1] ? rows >> 1 : 0; row < rows; row++) {
      const source = flips[1] ? rows - 1 - row : row
      for (let column = flips[1] ? 0 : columns >> 1; column < columns; column++) {
        const [to, from] = [row * columns + column, source * columns + (flips[0] ? columns - 1 - column : column)]
        if (from >= to) continue
        fate[to] = fate[from] > 0 ? this.#mirror[fate[from]] : fate[from]
        time[to] = time[from]
        crossings[to] = crossings[from]
      }
    }
    return this.pixels
  }
}

/**
 * Return whether each axis of a view changes its direction under x → −x; null for a view without this symmetry.
 *
 * @param {import("../engine/system.js").System} system
 * @param {Pick<import("../engine/system.js").Slice, "mirrored">} slice
 * @param {import("../engine/starts.js").Window} window
 * @returns {[boolean, boolean] | null}
 */
export function mirroredAxes(system, {mirrored}, {xLow, xHigh, ordinateLow, ordinateHigh}) {
  if (!system.mirror || !mirrored || !(mirrored[0] || mirrored[1])) return null
  const isSymmetric = (!mirrored[0] || xLow === -xHigh) && (!mirrored[1] || ordinateLow === -ordinateHigh)
  return isSymmetric ? mirrored : null
}
