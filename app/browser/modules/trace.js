// @ts-check
/** One orbit with its path, for the card beside the cursor. */

import {crossedExit, exitCurves, findExitTime, passedExit} from "./exits.js"
import {FLAGS, PX, PY, SIZE, T, X, X_REMAINDER, Y, Y_REMAINDER} from "./integrator.js"
import {countUpwardCrossings, seriesValue} from "./series.js"

/**
 * @typedef {object} Trace
 * @property {number[]} x
 * @property {number[]} y
 * @property {number} channel  number of the exit, 0 if the orbit is inside at the end
 * @property {number} time  at the end, in units of the well
 * @property {number} crossings
 *
 * @typedef {{x: number, y: number, px: number, py: number, h: number}} Start
 */

/** Points of the path in a step. */
const POINTS = 6

/**
 * Follow an orbit until it escapes or for a duration in units of the well.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Start} start
 * @param {number} duration
 * @returns {Trace}
 */
export function traceOrbit(integrator, start, duration) {
  const {lanes, system, starts, x, y} = integrator
  const exits = exitCurves(system.exits, start.h)
  integrator.prepare(system.layout.tolerance, duration, exits)
  integrator.now.rows.fill(0.01)
  for (const [row, value] of [
    [X, start.x],
    [Y, start.y],
    [PX, start.px],
    [PY, start.py],
    [T, 0],
    [X_REMAINDER, 0],
    [Y_REMAINDER, 0],
  ]) {
    integrator.now.rows[row * lanes] = value
  }
  /** @type {Trace} */
  const trace = {x: [start.x], y: [start.y], channel: 0, time: 0, crossings: 0}
  while (trace.time < duration && trace.channel === 0) {
    integrator.step(1)
    const [before, after] = [integrator.next.rows, integrator.now.rows]
    const isNear = integrator.now.integers[2 * FLAGS * lanes] & system.layout.near
    const size = after[SIZE * lanes]
    if (!(size > 0)) break
    for (const [row, place] of [X, Y, PX, PY].entries()) starts[row * lanes] = before[place * lanes]
    integrator.jets(1)
    const [x0, y0] = [before[X * lanes], before[Y * lanes]]
    trace.channel = crossedExit(exits, x0, y0, after[X * lanes], after[Y * lanes])
    if (trace.channel === 0 && isNear) trace.channel = passedExit(exits, x, y, 0, size)
    let taken = Math.min(size, duration - trace.time)
    if (trace.channel > 0) {
      const tau = findExitTime(exits[trace.channel - 1], x, y, 0, size)
      if (tau > taken) trace.channel = 0
      else taken = tau
    }
    for (let k = 1; k <= POINTS; k++) {
      trace.x.push(seriesValue(x, 0, (taken * k) / POINTS))
      trace.y.push(seriesValue(y, 0, (taken * k) / POINTS))
    }
    trace.crossings += countUpwardCrossings(y, 0, taken)
    trace.time += taken
  }
  return trace
}
