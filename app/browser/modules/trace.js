// @ts-check
/** One orbit with its path, for the card beside the cursor. */

import {Exits} from "./exits.js"
import {makeOrbits} from "./propagate.js"
import {evaluateSeries} from "./series.js"

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
/** Steps that are taken at a time. */
const PORTION = 512

/**
 * Follow an orbit until it escapes or for a duration in units of the well.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Start} start
 * @param {number} duration
 * @returns {Trace}
 */
export function traceOrbit(integrator, start, duration) {
  return integrator.temporarily(() => follow(integrator, start, duration))
}

/** @type {typeof traceOrbit} */
function follow(integrator, {x, y, px, py, h}, duration) {
  const {address, table, system} = integrator
  const {fates, tolerance, lanes_together} = system.layout
  const exits = new Exits(integrator, [h])
  const orbits = makeOrbits(integrator, Float64Array.of(x, y, px, py))
  const [todo, row] = [integrator.array("int64", [1]), integrator.array("int64", [1])]
  const steps = integrator.array("float64", [PORTION, 5])
  const settings = [duration, 1, tolerance, lanes_together * PORTION, 0]
  const end = () => (orbits.fate.values[0] === fates.bounded ? duration : orbits.t.values[0])
  const [xs, ys] = [[x], [y]]
  while (orbits.pending.values[0]) {
    const [step, jets] = [address.step, address.jets]
    const all = [exits.gates, exits.curves, row, ...Object.values(orbits), steps]
    const count = integrator.call("propagate", step, jets, table, todo, ...settings, ...all)
    const path = sampleSteps(integrator, steps, count, end())
    xs.push(...path[0])
    ys.push(...path[1])
  }
  const crossings = orbits.crossings.values[0] + orbits.lastCrossings.values[0]
  return {x: xs, y: ys, channel: Math.max(orbits.fate.values[0], 0), time: end(), crossings}
}

/**
 * x and y at some times in each of the first steps.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./integrator.js").Numbers<"float64">} steps  x, y, px, py, t at the start of each
 * @param {number} count  of the steps
 * @param {number} end  of the last one
 */
function sampleSteps(integrator, steps, count, end) {
  const {address, table, system} = integrator
  return integrator.temporarily(() => {
    const width = count + (count % 2)
    const start = integrator.array("float64", [4, width])
    const series = integrator.array("float64", [2, system.layout.order + 1, width])
    const [rows, times] = [/** @type {number[]} */ ([]), /** @type {number[]} */ ([])]
    for (let k = 0; k < count; k++) {
      const [x, y, px, py, begin] = steps.values.subarray(5 * k, 5 * k + 5)
      ;[x, y, px, py].forEach((value, row) => (start.values[row * width + k] = value))
      const size = (k + 1 < count ? steps.values[5 * k + 9] : end) - begin
      for (let part = 1; part <= POINTS; part++) {
        rows.push(k)
        times.push((size * part) / POINTS)
      }
    }
    integrator.call("compute_series", address.jets, table, start, series)
    return evaluateSeries(integrator, series, rows, times)
  })
}
