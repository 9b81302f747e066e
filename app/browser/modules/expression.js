// @ts-check
/** A potential as a list of operations, evaluated one after the other; see `engine/expressions/graph.py`. */

/**
 * @typedef {object} Node
 * @property {string} kind
 * @property {number[]} operands  indices of nodes
 * @property {number[]} numbers  coefficients of a sum, one for each operand, and its constant; the number of a shift
 * @property {number} exponent  of a power
 *
 * @typedef {object} Graph
 * @property {Node[]} nodes
 * @property {[number, number, number]} results  indices of V, V_x and V_y
 * @property {number} innerRadius  radius of the disc around a centre at the origin; 0 for a well there
 */

/** Parts of a line to the origin, and points at the edge of a disc there. */
const [PIECES, EDGE_POINTS] = [32, 64]

/** @type {Record<string, (node: Node, values: Float64Array, x: number, y: number) => number>} */
const OPERATIONS = {
  x: (_, values, x) => x,
  y: (_, values, x, y) => y,
  sum: ({operands, numbers}, values) => {
    let total = numbers[operands.length] ?? 0
    for (let k = 0; k < operands.length; k++) total += numbers[k] * values[operands[k]]
    return total
  },
  shift: ({operands, numbers}, values) => values[operands[0]] + numbers[0],
  product: ({operands}, values) => values[operands[0]] * values[operands[1]],
  power: ({operands, exponent}, values) => values[operands[0]] ** exponent,
  exp: ({operands}, values) => Math.exp(values[operands[0]]),
  log: ({operands}, values) => Math.log(values[operands[0]]),
  sin: ({operands}, values) => Math.sin(values[operands[0]]),
  cos: ({operands}, values) => Math.cos(values[operands[0]]),
}

export class Expression {
  /** @param {Graph} graph */
  constructor({nodes, results, innerRadius}) {
    this.#nodes = nodes
    this.#operations = nodes.map(({kind}) => OPERATIONS[kind])
    this.#results = results
    this.#values = new Float64Array(nodes.length)
    this.slopeX = 0
    this.slopeY = 0
    this.#innerRadius = innerRadius
    const edge = Array.from({length: EDGE_POINTS}, (_, k) => (2 * Math.PI * k) / EDGE_POINTS)
    this.bottom = Math.min(...edge.map(angle => this.value(innerRadius * Math.cos(angle), innerRadius * Math.sin(angle))))
  }

  #nodes
  #operations
  #results
  #values
  #innerRadius
  #x = 0
  #y = 0

  /**
   * @param {number} x
   * @param {number} y
   */
  value(x, y) {
    const values = this.#values
    for (let k = 0; k < values.length; k++) values[k] = this.#operations[k](this.#nodes[k], values, x, y)
    return values[this.#results[0]]
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  expand(x, y) {
    this.#x = x
    this.#y = y
    const value = this.value(x, y)
    this.slopeX = this.#values[this.#results[1]]
    this.slopeY = this.#values[this.#results[2]]
    return value
  }

  /**
   * Whether V on the line is at most a level: all Bernstein coefficients of a cubic with its values and slopes on each part are.
   *
   * @param {number} level
   */
  staysBelow(level) {
    const first = this.#innerRadius > 0 ? this.#innerRadius / Math.max(this.#innerRadius, Math.hypot(this.#x, this.#y)) : 0
    const part = (1 - first) / PIECES
    for (let piece = 0; piece <= PIECES; piece++) {
      const t = first + piece * part
      const value = this.value(t * this.#x, t * this.#y)
      const slope = this.#values[this.#results[1]] * this.#x + this.#values[this.#results[2]] * this.#y
      const rise = (slope * part) / 3
      const highest = Math.max(value, piece > 0 ? value - rise : value, piece < PIECES ? value + rise : value)
      if (!(highest <= level)) return false
    }
    return true
  }
}
