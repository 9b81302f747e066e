// @ts-check
/** V, its gradient, and whether V on the line to the origin is below a level. */

import {Expression} from "./expression.js"

/**
 * @typedef {object} Potential
 * @property {number} slopeX  V_x at the last point expanded
 * @property {number} slopeY
 * @property {number} bottom  V at the origin; at a centre there the lowest V at the edge of its disc
 * @property {(x: number, y: number) => number} value
 * @property {(x: number, y: number) => number} expand  V; sets the slopes as well
 * @property {(level: number) => boolean} staysBelow  whether V on the line from the origin, or from the disc around a centre there, to the last point expanded is at most a level
 */

/** @type {Record<string, (formula: any) => Potential>} */
const KINDS = {
  terms: terms => new Polynomial(terms),
  graph: graph => new Expression(graph),
}

/**
 * @param {import("./system.js").Formula} formula
 * @returns {Potential}
 */
export function makePotential(formula) {
  const [[kind, data]] = Object.entries(formula)
  return KINDS[kind](data)
}

export class Polynomial {
  /** @param {[number, number, number][]} terms  [i, j, c] of V = Σ c x^i y^j */
  constructor(terms) {
    this.#terms = terms
    const degree = terms.reduce((most, [i, j]) => Math.max(most, i + j), 0)
    this.#x = new Float64Array(degree + 1)
    this.#y = new Float64Array(degree + 1)
    this.#ray = new Float64Array(degree + 1)
    this.#bernstein = bernsteinMatrix(degree)
    this.slopeX = 0
    this.slopeY = 0
  }

  #terms
  #x
  #y
  /** Coefficients of V(t x, t y) as a series in t, at the last point expanded. */
  #ray
  #bernstein

  get bottom() {
    return this.value(0, 0)
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  value(x, y) {
    this.#fillPowers(x, y)
    let value = 0
    for (const [i, j, c] of this.#terms) value += c * this.#x[i] * this.#y[j]
    return value
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  expand(x, y) {
    this.#fillPowers(x, y)
    this.#ray.fill(0)
    let [value, slopeX, slopeY] = [0, 0, 0]
    for (const [i, j, c] of this.#terms) {
      const term = c * this.#x[i] * this.#y[j]
      value += term
      this.#ray[i + j] += term
      if (i > 0) slopeX += c * i * this.#x[i - 1] * this.#y[j]
      if (j > 0) slopeY += c * j * this.#x[i] * this.#y[j - 1]
    }
    this.slopeX = slopeX
    this.slopeY = slopeY
    return value
  }

  /**
   * Whether all Bernstein coefficients of V on the line, and with them V there, are at most a level.
   *
   * @param {number} level
   */
  staysBelow(level) {
    for (const row of this.#bernstein) {
      let b = 0
      for (let k = 0; k < row.length; k++) b += row[k] * this.#ray[k]
      if (b > level) return false
    }
    return true
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  #fillPowers(x, y) {
    let [powerX, powerY] = [1, 1]
    for (let k = 0; k < this.#x.length; k++) {
      this.#x[k] = powerX
      this.#y[k] = powerY
      powerX *= x
      powerY *= y
    }
  }
}

/**
 * From the coefficients of a power series on [0, 1] to those of Bernstein polynomials; row i has the first i + 1 columns.
 *
 * @param {number} degree
 */
function bernsteinMatrix(degree) {
  const choose = (/** @type {number} */ n, /** @type {number} */ k) => {
    let value = 1
    for (let i = 0; i < k; i++) value = (value * (n - i)) / (i + 1)
    return value
  }
  return Array.from({length: degree + 1}, (_, i) => Array.from({length: i + 1}, (_, k) => choose(i, k) / choose(degree, k)))
}
