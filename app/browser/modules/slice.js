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

/** The plane of the positions. @type {import("./system.js").Slice} */
export const SPACE = {axes: ["x", "y"], fixed: {px: 0}, decided: "py", sign: 1}

/** Coordinates that change their sign under x → −x. */
const ODD = ["x", "px"]

/**
 * The number by which a coordinate is divided for units of the well.
 *
 * @param {{length: number, time: number}} units
 * @param {import("./system.js").Coordinate} coordinate
 */
export function unitOf({length, time}, coordinate) {
  const momentum = length / time
  return {x: length, y: length, px: momentum, py: momentum, h: momentum * momentum}[coordinate]
}

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
   * @param {import("./system.js").Slice} slice
   * @param {import("./potential.js").Potential} potential
   * @param {number} energy  used unless h is an axis
   */
  constructor({axes, fixed, decided, sign}, potential, energy) {
    /** The start that was found last, and its energy. */
    this.found = {x: 0, y: 0, px: 0, py: 0, h: energy, ...fixed}
    this.#axes = axes
    this.#energyAxis = energyAxis({axes})
    this.#decided = decided
    this.#sign = sign
    this.#potential = potential
  }

  #axes
  #energyAxis
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
    const doubled = 2 * (this.found.h - this.#restEnergy())
    this.found[this.#decided] = this.#sign * Math.sqrt(Math.max(doubled, 0))
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
    this.found[this.#axes[0]] = abscissa
    this.found[this.#axes[1]] = ordinate
  }

  /** The energy without the momentum that is decided. */
  #restEnergy() {
    const {x, y, px, py} = this.found
    const other = this.#decided === "py" ? px : py
    return 0.5 * other * other + this.#potential.value(x, y)
  }
}

/**
 * Which axes of a view change their direction under x → −x; null if the view is not its own mirror image.
 *
 * @param {import("./system.js").System} system
 * @param {import("./system.js").Slice} slice
 * @param {Window} window
 * @returns {[boolean, boolean] | null}
 */
export function mirroredAxes(system, {axes, fixed, decided}, {xLow, xHigh, ordinateLow, ordinateHigh}) {
  const flips = /** @type {[boolean, boolean]} */ (axes.map(axis => ODD.includes(axis)))
  const moved = Object.entries(fixed).some(([name, value]) => ODD.includes(name) && value !== 0)
  if (!system.mirror || moved || ODD.includes(decided) || !(flips[0] || flips[1])) return null
  const symmetric = (!flips[0] || xLow === -xHigh) && (!flips[1] || ordinateLow === -ordinateHigh)
  return symmetric ? flips : null
}
