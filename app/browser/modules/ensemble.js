// @ts-check
/**
 * Many orbits at the same time. Each keeps the series of its present step, so that its place at any time within the step costs two
 * polynomials; steps are taken in full vectors of lanes.
 */

import {crossedExit, exitCurves, findExitTime, passedExit} from "./exits.js"
import {FLAGS, PX, PY, SIZE, T, X, X_REMAINDER, Y, Y_REMAINDER} from "./integrator.js"
import {seriesSlope, seriesValue} from "./series.js"

/** Orbits are followed for this long beyond an exit that is no disc, in units of the well. */
export const FOLLOWED_BEYOND = 1.5
const ROOT_HALVINGS = 40
/** What a step takes and gives of each orbit, besides the time. */
const STATE = [X, Y, PX, PY, X_REMAINDER, Y_REMAINDER]

export class Ensemble {
  /**
   * @param {import("./integrator.js").Integrator} integrator
   * @param {number} energy  in units of the well
   * @param {Float64Array} states  x, y, px, py of each start, in units of the well
   */
  constructor(integrator, energy, states) {
    const count = states.length / 4
    this.#integrator = integrator
    this.#exits = exitCurves(integrator.system.exits, energy)
    this.#starts = states
    this.#terms = integrator.system.layout.order + 1
    this.#series = new Float64Array(2 * this.#terms * count)
    this.#ends = new Float64Array(STATE.length * count)
    this.#begin = new Float64Array(count)
    this.#size = new Float64Array(count)
    this.#leaving = new Uint8Array(count)
    this.count = count
    /** Places at the present time; NaN for orbits that are far outside. */
    this.x = new Float64Array(count)
    this.y = new Float64Array(count)
    /** Number of the exit at which each orbit has ended so far, 0 for orbits inside, and when. */
    this.channel = new Uint8Array(count)
    this.escapeTime = new Float64Array(count)
    this.#last = new Float64Array(count)
    /** x and px of the last upward crossing of y = 0; NaN before the first one. */
    this.sectionX = new Float64Array(count)
    this.sectionPx = new Float64Array(count)
    /** In units of the well. */
    this.time = 0
    this.restart()
  }

  #integrator
  #exits
  #starts
  #terms
  #series
  #ends
  #begin
  #size
  /** Number of the exit through which the present step leads out, or an earlier one has; 0 for none. */
  #leaving
  /** Time until which each orbit is shown. */
  #last

  /** Put all orbits back to their starts. */
  restart() {
    this.time = 0
    this.#ends.fill(0)
    this.#begin.fill(0)
    this.#size.fill(0)
    this.#leaving.fill(0)
    this.channel.fill(0)
    this.escapeTime.fill(Infinity)
    this.#last.fill(Infinity)
    this.sectionX.fill(NaN)
    this.sectionPx.fill(NaN)
    for (let i = 0; i < this.count; i++) {
      this.#ends.set(this.#starts.subarray(4 * i, 4 * i + 4), STATE.length * i)
      this.x[i] = this.#starts[4 * i]
      this.y[i] = this.#starts[4 * i + 1]
    }
  }

  /**
   * Follow all orbits to a time, in units of the well; an earlier one than the present begins at the starts again.
   *
   * @param {number} time
   */
  advance(time) {
    if (time < this.time) this.restart()
    for (let late = this.#late(time); late.length > 0; late = this.#late(time)) {
      const {lanes} = this.#integrator
      for (let first = 0; first < late.length; first += lanes) this.#step(late.slice(first, first + lanes), time)
    }
    this.time = time
    for (let i = 0; i < this.count; i++) this.#place(i, time)
  }

  /** How many times as wide as at their starts the orbits are spread that are still inside. */
  growth() {
    const inside = [...this.channel.keys()].filter(i => this.channel[i] === 0)
    const starts = this.#starts
    const before = width(inside, i => starts[4 * i]) ** 2 + width(inside, i => starts[4 * i + 1]) ** 2
    const now = width(inside, i => this.x[i]) ** 2 + width(inside, i => this.y[i]) ** 2
    return Math.sqrt(now / before)
  }

  /** Momenta at the present time, which is after the first step; those of orbits that have left mean nothing. */
  momenta() {
    const [px, py] = [new Float64Array(this.count), new Float64Array(this.count)]
    for (let i = 0; i < this.count; i++) {
      const [first, tau] = [2 * this.#terms * i, this.time - this.#begin[i]]
      px[i] = slope(this.#series, first, this.#terms, tau)
      py[i] = slope(this.#series, first + this.#terms, this.#terms, tau)
    }
    return {px, py}
  }

  /**
   * Numbers of the orbits whose step ends before a time.
   *
   * @param {number} time
   */
  #late(time) {
    const late = []
    for (let i = 0; i < this.count; i++) {
      const end = this.#begin[i] + this.#size[i]
      // A size that is no number is that of an orbit that has broken down far outside.
      if (end < time && end < this.#last[i]) late.push(i)
    }
    return late
  }

  /**
   * The next step of some orbits.
   *
   * @param {number[]} orbits
   * @param {number} horizon
   */
  #step(orbits, horizon) {
    const integrator = this.#integrator
    const {lanes, starts, system} = integrator
    integrator.prepare(system.layout.tolerance, horizon, this.#exits)
    integrator.now.rows.fill(0.01)
    orbits.forEach((orbit, lane) => {
      this.#begin[orbit] += this.#size[orbit]
      integrator.now.rows[T * lanes + lane] = this.#begin[orbit]
      for (const [place, row] of STATE.entries()) {
        const value = this.#ends[STATE.length * orbit + place]
        integrator.now.rows[row * lanes + lane] = value
        if (place < 4) starts[place * lanes + lane] = value
      }
    })
    integrator.step(orbits.length)
    integrator.jets(orbits.length)
    orbits.forEach((orbit, lane) => this.#keep(orbit, lane))
  }

  /**
   * Keep the step of a lane: its series, its end, and its events.
   *
   * @param {number} orbit
   * @param {number} lane
   */
  #keep(orbit, lane) {
    const {lanes, now, x, y} = this.#integrator
    const size = now.rows[SIZE * lanes + lane]
    this.#size[orbit] = size > 0 ? size : NaN
    const first = 2 * this.#terms * orbit
    for (let k = 0; k < this.#terms; k++) {
      this.#series[first + k] = x.jet[x.first + k * x.stride + lane]
      this.#series[first + this.#terms + k] = y.jet[y.first + k * y.stride + lane]
    }
    const [x0, y0] = [this.#series[first], this.#series[first + this.#terms]]
    const end = STATE.length * orbit
    for (const [place, row] of STATE.entries()) this.#ends[end + place] = now.rows[row * lanes + lane]
    const [x1, y1] = [this.#ends[end], this.#ends[end + 1]]
    if (this.escapeTime[orbit] < Infinity) return
    const isNear = now.integers[2 * (FLAGS * lanes + lane)] & this.#integrator.system.layout.near
    const crossed = crossedExit(this.#exits, x0, y0, x1, y1)
    const channel = crossed === 0 && isNear ? passedExit(this.#exits, x, y, lane, size) : crossed
    this.#leaving[orbit] = channel
    if (channel > 0) {
      const exit = this.#exits[channel - 1]
      this.escapeTime[orbit] = this.#begin[orbit] + findExitTime(exit, x, y, lane, size)
      this.#last[orbit] = this.escapeTime[orbit] + (exit.side < 0 ? 0 : FOLLOWED_BEYOND)
    }
    if (y0 < 0 && y1 >= 0) this.#cross(orbit, lane, size)
  }

  /**
   * Note where an orbit crosses y = 0 upward.
   *
   * @param {number} orbit
   * @param {number} lane
   * @param {number} size
   */
  #cross(orbit, lane, size) {
    const {x, y} = this.#integrator
    let [low, high] = [0, size]
    for (let k = 0; k < ROOT_HALVINGS; k++) {
      const middle = 0.5 * (low + high)
      if (seriesValue(y, lane, middle) < 0) low = middle
      else high = middle
    }
    this.sectionX[orbit] = seriesValue(x, lane, high)
    this.sectionPx[orbit] = seriesSlope(x, lane, high)
  }

  /**
   * The place of an orbit at a time within its step.
   *
   * @param {number} orbit
   * @param {number} time
   */
  #place(orbit, time) {
    const left = this.escapeTime[orbit]
    if (time >= left) this.channel[orbit] = this.#leaving[orbit]
    const tau = time - this.#begin[orbit]
    const first = 2 * this.#terms * orbit
    const far = time > this.#last[orbit] || !(tau <= this.#size[orbit])
    // An orbit that has not begun its first step is at its start.
    if (tau === 0 && this.#size[orbit] === 0) return
    this.x[orbit] = far ? NaN : horner(this.#series, first, this.#terms, tau)
    this.y[orbit] = far ? NaN : horner(this.#series, first + this.#terms, this.#terms, tau)
  }
}

/**
 * Standard deviation of a number of some orbits.
 *
 * @param {number[]} orbits
 * @param {(orbit: number) => number} value
 */
function width(orbits, value) {
  let [sum, squares] = [0, 0]
  // Relative to the first one: those of a small disc differ in their last digits only.
  const origin = orbits.length ? value(orbits[0]) : 0
  for (const orbit of orbits) {
    const difference = value(orbit) - origin
    sum += difference
    squares += difference * difference
  }
  return Math.sqrt(Math.max(squares / orbits.length - (sum / orbits.length) ** 2, 0))
}

/**
 * Derivative of `horner` with respect to tau.
 *
 * @param {Float64Array} series
 * @param {number} first
 * @param {number} terms
 * @param {number} tau
 */
function slope(series, first, terms, tau) {
  let value = (terms - 1) * series[first + terms - 1]
  for (let k = terms - 2; k > 0; k--) value = value * tau + k * series[first + k]
  return value
}

/**
 * @param {Float64Array} series
 * @param {number} first
 * @param {number} terms
 * @param {number} tau
 */
function horner(series, first, terms, tau) {
  let value = series[first + terms - 1]
  for (let k = first + terms - 2; k >= first; k--) value = value * tau + series[k]
  return value
}
