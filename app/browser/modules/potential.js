// @ts-check
/** V, its gradient, and V along the line to the origin. */

export class Potential {
  /** @param {[number, number, number][]} terms  [i, j, c] of V = Σ c x^i y^j */
  constructor(terms) {
    this.#terms = terms
    this.degree = terms.reduce((most, [i, j]) => Math.max(most, i + j), 0)
    this.#x = new Float64Array(this.degree + 1)
    this.#y = new Float64Array(this.degree + 1)
    /** Coefficients of V(t x, t y) as a series in t, at the last point expanded. */
    this.ray = new Float64Array(this.degree + 1)
    this.slopeX = 0
    this.slopeY = 0
  }

  #terms
  #x
  #y

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
   * V; sets `ray`, `slopeX` and `slopeY` as well.
   *
   * @param {number} x
   * @param {number} y
   */
  expand(x, y) {
    this.#fillPowers(x, y)
    this.ray.fill(0)
    let [value, slopeX, slopeY] = [0, 0, 0]
    for (const [i, j, c] of this.#terms) {
      const term = c * this.#x[i] * this.#y[j]
      value += term
      this.ray[i + j] += term
      if (i > 0) slopeX += c * i * this.#x[i - 1] * this.#y[j]
      if (j > 0) slopeY += c * j * this.#x[i] * this.#y[j - 1]
    }
    this.slopeX = slopeX
    this.slopeY = slopeY
    return value
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  #fillPowers(x, y) {
    let [powerX, powerY] = [1, 1]
    for (let k = 0; k <= this.degree; k++) {
      this.#x[k] = powerX
      this.#y[k] = powerY
      powerX *= x
      powerY *= y
    }
  }
}
