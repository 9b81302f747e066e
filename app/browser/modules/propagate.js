// @ts-check
/**
 * The loop over steps that propagates orbits until they escape or pass a horizon, with the logic of
 * `engine/integrator/kernels/propagate.py`: a lane whose orbit ends takes the next one, and steps with events are collected until
 * their series can be computed together.
 */

import {crossedExit, findExitTime, passedExit} from "./exits.js"
import {BLOCK_ROWS, CROSSED, FLAGS, SIZE, T, X, X_REMAINDER, Y, Y_REMAINDER} from "./integrator.js"
import {countUpwardCrossings, seriesValue} from "./series.js"

/**
 * Orbits to propagate, and what is found of them.
 *
 * @typedef {object} Orbits
 * @property {Float64Array} state  x, y, px, py of each orbit
 * @property {Uint32Array} todo  numbers of the orbits to propagate
 * @property {(orbit: number) => import("./exits.js").ExitCurve[]} exits  of an orbit
 * @property {Int8Array} fate
 * @property {Float64Array} time  of the escape
 * @property {Uint16Array} crossings
 */

const GOES_ON = -1
const MOST_CROSSINGS = 65535

/**
 * Propagate orbits from t = 0; those still inside at the horizon stay undecided.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Orbits} orbits
 * @param {number} horizon
 * @param {number} tolerance
 * @param {Pick<import("./exits.js").ExitCurve, "gate">[]} gates  inside the exits of all orbits
 */
export function propagate(integrator, orbits, horizon, tolerance, gates) {
  integrator.prepare(tolerance, horizon, gates)
  new Propagation(integrator, orbits, horizon).run()
}

class Propagation {
  /**
   * @param {import("./integrator.js").Integrator} integrator
   * @param {Orbits} orbits
   * @param {number} horizon
   */
  constructor(integrator, orbits, horizon) {
    const {lanes, system} = integrator
    this.integrator = integrator
    this.orbits = orbits
    this.horizon = horizon
    this.layout = system.layout
    this.lanes = lanes
    this.lane_orbit = new Int32Array(lanes)
    this.following = 0
    this.active = 0
    // Steps whose events are still to be located.
    this.buffered = 0
    this.orbit = new Int32Array(lanes)
    this.channel = new Int8Array(lanes)
    this.begin = new Float64Array(lanes)
    this.size = new Float64Array(lanes)
  }

  run() {
    const {integrator, lanes} = this
    this.active = Math.min(lanes, this.orbits.todo.length)
    // Lanes without an orbit take harmless steps.
    integrator.now.rows.fill(0.01)
    for (let i = 0; i < this.active; i++) this.load(integrator.now, i)
    while (this.active > 0) {
      integrator.step(this.active)
      this.examine(integrator.next, integrator.now)
    }
    this.locate()
  }

  /**
   * Look at a step of all lanes, downward, since the last active lane replaces one whose orbit has ended.
   *
   * @param {import("./integrator.js").Block} before
   * @param {import("./integrator.js").Block} after
   */
  examine(before, after) {
    const {lanes, lane_orbit} = this
    const {integers} = after
    const {crossings} = this.orbits
    for (let i = this.active - 1; i >= 0; i--) {
      crossings[lane_orbit[i]] += integers[2 * (CROSSED * lanes + i)]
      if (integers[2 * (FLAGS * lanes + i)]) this.judge(i, before, after)
    }
  }

  /**
   * A flagged step of lane i: does the orbit end, and are there events to be located?
   *
   * @param {number} i
   * @param {import("./integrator.js").Block} before
   * @param {import("./integrator.js").Block} after
   */
  judge(i, before, after) {
    const {lanes, layout, orbits} = this
    const [now, next] = [before.rows, after.rows]
    const flags = after.integers[2 * (FLAGS * lanes + i)]
    const orbit = this.lane_orbit[i]
    const [x, y] = [next[X * lanes + i], next[Y * lanes + i]]
    const failed = !(Number.isFinite(x) && Number.isFinite(y) && next[SIZE * lanes + i] > 0)
    const late = (flags & layout.overshoot) !== 0
    let channel = 0
    if (!late && flags & (layout.gate | layout.near)) {
      channel = crossedExit(orbits.exits(orbit), now[X * lanes + i], now[Y * lanes + i], x, y)
    }
    if (flags & layout.near && !late && channel === 0 && !failed) channel = this.findPassed(i, now, next)
    const ends = late || channel > 0 || failed
    if (failed) orbits.fate[orbit] = layout.fates.failed
    else if (ends || flags & layout.hidden) this.buffer(i, now, next, ends ? channel : GOES_ON)
    else if (now[Y * lanes + i] < 0 && y >= 0) orbits.crossings[orbit]++
    if (!ends) return
    if (this.following < orbits.todo.length) this.load(after, i)
    else this.move(after, --this.active, i)
  }

  /**
   * The number of the exit that the orbit of lane i passes and leaves again within a step, 0 for none.
   *
   * @param {number} i
   * @param {Float64Array} now
   * @param {Float64Array} next
   */
  findPassed(i, now, next) {
    const {lanes, integrator} = this
    const k = this.buffered
    for (let row = 0; row < 4; row++) integrator.starts[row * lanes + k] = now[(X + row) * lanes + i]
    integrator.jetsOf(k)
    return passedExit(this.orbits.exits(this.lane_orbit[i]), integrator.x, integrator.y, k, next[SIZE * lanes + i])
  }

  /**
   * Put the next orbit into lane i.
   *
   * @param {import("./integrator.js").Block} block
   * @param {number} i
   */
  load({rows}, i) {
    const {lanes} = this
    const orbit = this.orbits.todo[this.following++]
    for (let c = 0; c < 4; c++) rows[(X + c) * lanes + i] = this.orbits.state[4 * orbit + c]
    for (const row of [T, X_REMAINDER, Y_REMAINDER]) rows[row * lanes + i] = 0
    this.lane_orbit[i] = orbit
  }

  /**
   * @param {import("./integrator.js").Block} block
   * @param {number} source
   * @param {number} target
   */
  move({rows}, source, target) {
    const {lanes} = this
    for (let row = X; row < BLOCK_ROWS; row++) rows[row * lanes + target] = rows[row * lanes + source]
    this.lane_orbit[target] = this.lane_orbit[source]
  }

  /**
   * Keep the step of lane i until its events are located.
   *
   * @param {number} i
   * @param {Float64Array} now
   * @param {Float64Array} next
   * @param {number} channel  GOES_ON if the orbit does not end, 0 if the step passes the horizon
   */
  buffer(i, now, next, channel) {
    const {lanes, integrator} = this
    const k = this.buffered++
    for (let row = 0; row < 4; row++) integrator.starts[row * lanes + k] = now[(X + row) * lanes + i]
    this.begin[k] = now[T * lanes + i]
    this.size[k] = next[SIZE * lanes + i]
    this.orbit[k] = this.lane_orbit[i]
    this.channel[k] = channel
    if (this.buffered === lanes) this.locate()
  }

  /** Locate the events of the steps in the buffer. */
  locate() {
    if (this.buffered === 0) return
    this.integrator.jets(this.buffered)
    for (let k = 0; k < this.buffered; k++) this.locateIn(k)
    this.buffered = 0
  }

  /** @param {number} k */
  locateIn(k) {
    const {integrator, orbits, horizon} = this
    const {x, y} = integrator
    const [orbit, size, begin] = [this.orbit[k], this.size[k], this.begin[k]]
    let channel = this.channel[k]
    let duration = size
    if (channel !== GOES_ON) {
      const curves = orbits.exits(orbit)
      if (channel === 0) {
        const [x0, y0] = [seriesValue(x, k, 0), seriesValue(y, k, 0)]
        channel = crossedExit(curves, x0, y0, seriesValue(x, k, size), seriesValue(y, k, size))
        if (channel === 0) channel = passedExit(curves, x, y, k, size)
      }
      const tau = channel > 0 ? findExitTime(curves[channel - 1], x, y, k, size) : size
      const escapes = channel > 0 && begin + tau <= horizon
      duration = escapes ? tau : horizon - begin
      orbits.fate[orbit] = escapes ? channel : this.layout.fates.not_computed
      if (escapes) orbits.time[orbit] = begin + tau
    }
    orbits.crossings[orbit] = Math.min(orbits.crossings[orbit] + countUpwardCrossings(y, k, duration), MOST_CROSSINGS)
  }
}
