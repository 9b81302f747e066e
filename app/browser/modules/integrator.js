// @ts-check
/** The WebAssembly functions of one system, and the memory with their arrays. */

const BYTES = 8
const PAGE = 65536
const STATE_ROWS = 5

/**
 * Rows of lanes in memory; row r of lane i is `rows[r * lanes + i]`.
 *
 * A block of lanes begins with what step says of the step that led here: new crossings of y = 0 and flags, as integers; then x,
 * y, px, py, t, the size of the step, and what rounding has dropped from x and y, in systems whose steps carry it.
 *
 * @typedef {object} Block
 * @property {number} address  of the state, row 2
 * @property {number} begin  address of the block
 * @property {Int32Array} integers  the low halves of the integers are at even places
 * @property {Float64Array} rows
 */

export const CROSSED = 0
export const FLAGS = 1
export const X = 2
export const Y = 3
export const PX = 4
export const PY = 5
export const T = 6
export const SIZE = 7
export const X_REMAINDER = 8
export const Y_REMAINDER = 9
export const BLOCK_ROWS = 10

export class Integrator {
  /**
   * @param {import("./system.js").System} system
   * @param {WebAssembly.Module} module
   */
  constructor(system, module) {
    const {lanes, order} = system.layout
    this.system = system
    this.module = module
    this.lanes = lanes
    const sizes = [system.table.length, system.constants.length, BLOCK_ROWS * lanes, BLOCK_ROWS * lanes, STATE_ROWS * lanes]
    const total = sizes.reduce((sum, size) => sum + size, 2 * (order + 1) * lanes)
    const memory = new WebAssembly.Memory({initial: Math.ceil((total * BYTES) / PAGE) + 1})
    this.#exports = /** @type {Record<string, Function>} */ (
      new WebAssembly.Instance(module, {env: {__linear_memory: memory}}).exports
    )
    let end = 0
    const place = (/** @type {number} */ size) => (end += size) - size
    const array = (/** @type {number} */ begin, /** @type {number} */ size) =>
      new Float64Array(memory.buffer, begin * BYTES, size)
    this.#table = place(system.table.length) * BYTES
    array(this.#table / BYTES, system.table.length).set(system.table)
    const constants = place(system.constants.length)
    this.#constants = array(constants, system.constants.length)
    const block = () => {
      const begin = place(BLOCK_ROWS * lanes)
      return {
        address: (begin + X * lanes) * BYTES,
        begin: begin * BYTES,
        integers: new Int32Array(memory.buffer, begin * BYTES, 2 * X * lanes),
        rows: array(begin, BLOCK_ROWS * lanes),
      }
    }
    /** @type {Block} */
    this.now = block()
    /** @type {Block} */
    this.next = block()
    const starts = place(STATE_ROWS * lanes)
    /** Rows x, y, px, py of the steps whose series `jets` computes. */
    this.starts = array(starts, STATE_ROWS * lanes)
    const jet = place(2 * (order + 1) * lanes)
    const series = array(jet, 2 * (order + 1) * lanes)
    /** @type {import("./series.js").Jet} */
    this.x = {jet: series, first: 0, stride: lanes, order}
    /** @type {import("./series.js").Jet} */
    this.y = {jet: series, first: (order + 1) * lanes, stride: lanes, order}
    this.#addresses = {constants: constants * BYTES, starts: starts * BYTES, jet: jet * BYTES}
  }

  #exports
  #table
  #constants
  #addresses

  /**
   * Set what is the same for all lanes.
   *
   * @param {number} tolerance
   * @param {number} horizon
   * @param {Pick<import("./exits.js").ExitCurve, "gate">[]} gates
   */
  prepare(tolerance, horizon, gates) {
    /** @type {Record<string, number>} */
    const values = {tolerance, horizon}
    gates.forEach(({gate}, k) => {
      ;[values[`g${k}x`], values[`g${k}y`], values[`g${k}`]] = gate
    })
    this.#constants.set(this.system.constants.map(name => values[name]))
  }

  /**
   * One step of the first n lanes, from `now` to `next`, which then change their names.
   *
   * @param {number} n
   */
  step(n) {
    this.#exports.step(this.#table, this.#addresses.constants, this.now.address, this.next.begin, n)
    ;[this.now, this.next] = [this.next, this.now]
  }

  /**
   * Compute the series of the first n of `starts`.
   *
   * @param {number} n
   */
  jets(n) {
    this.#jets(0, n)
  }

  /**
   * Compute the series of one of `starts`, and of its neighbour in the pair that is computed together.
   *
   * @param {number} lane
   */
  jetsOf(lane) {
    this.#jets(BYTES * (lane & ~1), 1)
  }

  /**
   * @param {number} offset  of the first lane, in bytes
   * @param {number} n
   */
  #jets(offset, n) {
    const {constants, starts, jet} = this.#addresses
    this.#exports.jets(this.#table, constants, starts + offset, jet + offset, n)
  }
}
