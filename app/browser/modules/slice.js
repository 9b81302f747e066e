// @ts-check
/** The starts of a slice, in units of the well; see `Slice` in `system.js`. */

/**
 * A rectangle of a slice, in units of the page.
 *
 * @typedef {object} Window
 * @property {number} xLow
 * @property {number} xHigh
 * @property {number} ordinateLow
 * @property {number} ordinateHigh
 */

/**
 * The plane of the positions.
 *
 * @param {{length: number, time: number}} units
 * @returns {import("./system.js").Slice}
 */
export const space = ({length}) => ({
  axes: ["x", "y"],
  units: [length, length],
  moves: [{x: 1}, {y: 1}],
  fixed: {},
  decided: "py",
  sign: 1,
  mirrored: [true, false],
})

/**
 * Whether a slice shows positions.
 *
 * @param {Pick<import("./system.js").Slice, "axes">} slice
 */
export const showsPositions = ({axes}) => axes[0] === "x" && axes[1] === "y"

/**
 * The energy by which one is divided for units of the well.
 *
 * @param {{length: number, time: number}} units
 */
export const energyUnit = ({length, time}) => (length / time) ** 2

/**
 * Centres of the pixels along an axis; exactly symmetric if the edges are.
 *
 * @param {number} low
 * @param {number} high
 * @param {number} count
 */
export function pixelCentres(low, high, count) {
  return Float64Array.from({length: count}, (_, i) => 0.5 * (low + high) + (high - low) * ((2 * i + 1 - count) / (2 * count)))
}

/**
 * The axis along which the energy differs: 0 for the abscissa, 1 for the ordinate, -1 for neither.
 *
 * @param {Pick<import("./system.js").Slice, "axes">} slice
 */
export const energyAxis = ({axes}) => axes.indexOf("h")

/** The starts of the points of a slice. */
export class Starts {
  /**
   * @param {Pick<import("./system.js").Slice, "axes" | "moves" | "fixed" | "decided" | "sign">} slice
   * @param {{value: (x: number, y: number) => number}} potential
   * @param {number} energy  used unless h is an axis
   */
  constructor({axes, moves, fixed, decided, sign}, potential, energy) {
    this.#energyAxis = energyAxis({axes})
    const moved = Object.fromEntries(moves.flatMap(Object.keys).map(coordinate => [coordinate, 0]))
    this.#base = {x: 0, y: 0, px: 0, py: 0, theta: 0, ...moved, ...fixed, h: this.#energyAxis < 0 ? energy : 0}
    /** The start that was found last, and its energy. @type {import("./system.js").Start} */
    this.found = {...this.#base}
    this.#moves = moves.map(move => /** @type {[import("./system.js").Coordinate, number][]} */ (Object.entries(move)))
    this.#decided = decided
    this.#sign = sign
    this.#potential = potential
  }

  #energyAxis
  #base
  #moves
  #decided
  #sign
  #potential

  /**
   * Find the start of a point; false where it is forbidden.
   *
   * @param {number} abscissa
   * @param {number} ordinate
   */
  find(abscissa, ordinate) {
    this.#place(abscissa, ordinate)
    const {found} = this
    const doubled = 2 * (found.h - this.#restEnergy())
    const decided = this.#sign * Math.sqrt(Math.max(doubled, 0))
    if (this.#decided === "v") this.#launch(decided)
    else found[this.#decided] = decided
    return doubled >= 0
  }

  /**
   * The lowest energy at which a start exists; if the energy is an axis, by how much it is too low.
   *
   * @param {number} abscissa
   * @param {number} ordinate
   */
  requiredEnergy(abscissa, ordinate) {
    this.#place(abscissa, ordinate)
    return this.#restEnergy() - ([abscissa, ordinate][this.#energyAxis] ?? 0)
  }

  /**
   * @param {number} abscissa
   * @param {number} ordinate
   */
  #place(abscissa, ordinate) {
    Object.assign(this.found, this.#base)
    for (const [coordinate, component] of this.#moves[0]) this.found[coordinate] += component * abscissa
    for (const [coordinate, component] of this.#moves[1]) this.found[coordinate] += component * ordinate
  }

  /** The energy without the momentum that is decided. */
  #restEnergy() {
    const {x, y, px, py} = this.found
    const other = {px: py, py: px, v: 0}[this.#decided]
    return 0.5 * other * other + this.#potential.value(x, y)
  }

  /**
   * The momenta of a speed: θ is the angle from the +x axis, β that from the direction away from the origin, there from +y.
   *
   * @param {number} speed
   */
  #launch(speed) {
    const {found} = this
    const {x, y, beta} = found
    if (beta === undefined) {
      found.px = speed * Math.cos(found.theta)
      found.py = speed * Math.sin(found.theta)
      return
    }
    const radius = Math.hypot(x, y)
    const [awayX, awayY] = radius > 0 ? [x / radius, y / radius] : [0, 1]
    found.px = speed * (Math.cos(beta) * awayX - Math.sin(beta) * awayY)
    found.py = speed * (Math.cos(beta) * awayY + Math.sin(beta) * awayX)
  }
}

/**
 * Which axes of a view change their direction under x → −x; null if the view is not its own mirror image.
 *
 * @param {import("./system.js").System} system
 * @param {Pick<import("./system.js").Slice, "mirrored">} slice
 * @param {Window} window
 * @returns {[boolean, boolean] | null}
 */
export function mirroredAxes(system, {mirrored}, {xLow, xHigh, ordinateLow, ordinateHigh}) {
  if (!system.mirror || !mirrored || !(mirrored[0] || mirrored[1])) return null
  const symmetric = (!mirrored[0] || xLow === -xHigh) && (!mirrored[1] || ordinateLow === -ordinateHigh)
  return symmetric ? mirrored : null
}
