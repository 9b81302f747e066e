// @ts-check
/**
 * The outcomes of the starts of a slice at many energies: counts in maps of few pixels, from coarse to fine, first at both ends of a
 * range of energies, then in the middle, at the quarters, and so on.
 *
 * @typedef {import("./frames.js").Scene} Scene
 * @typedef {Map<number, number>} Counts  number of pixels of each fate
 */

/** Pixels along a side of a map. */
const SIDE = 32

export class Shares {
  /**
   * @param {(place: number) => Scene | null} sceneAt  returns the scene at a place of the range, 0 to 1; null if it has none
   * @param {number} horizon  integration time of the maps, in units of the well
   * @param {(place: number, counts: Counts) => void} show
   */
  constructor(sceneAt, horizon, show) {
    this.#sceneAt = sceneAt
    this.#horizon = horizon
    this.#show = show
  }

  #sceneAt
  #horizon
  #show
  /** Places without counts, the next one last. @type {number[]} */
  #missing = []
  /** Counts by place. @type {Map<number, Counts>} */
  counts = new Map()

  /**
   * Set the number of intervals between the energies. Counts that are known stay.
   *
   * @param {number} levels  binary logarithm of the number
   */
  refine(levels) {
    this.#missing = placesOf(levels)
      .filter(place => !this.counts.has(place))
      .reverse()
  }

  /** Return the next map to compute, with what takes its pixels; null if there is none. @returns {import("./frames.js").Extra | null} */
  next() {
    for (let place = this.#missing.at(-1); place !== undefined; place = this.#missing.at(-1)) {
      const scene = this.#sceneAt(place)
      if (scene) return this.#mapAt(place, scene)
      this.#missing.pop()
    }
    return null
  }

  /** @param {number} place @param {Scene} scene */
  #mapAt(place, scene) {
    const view = {...scene, columns: SIDE, rows: SIDE, horizon: this.#horizon}
    const receive = (/** @type {import("../engine/pixels.js").Pixels} */ {fate}) => {
      this.#missing.pop()
      /** @type {Counts} */
      const counts = new Map()
      for (const code of fate) counts.set(code, (counts.get(code) ?? 0) + 1)
      this.counts.set(place, counts)
      this.#show(place, counts)
    }
    return {view, receive}
  }
}

/**
 * Return 0, 1, 1/2, 1/4, 3/4, 1/8, … up to multiples of 1/2^levels.
 *
 * @param {number} levels
 */
export function placesOf(levels) {
  const places = [0, 1]
  for (let step = 1 / 2; step >= 1 / 2 ** levels; step /= 2)
    for (let place = step; place < 1; place += 2 * step) places.push(place)
  return places
}
