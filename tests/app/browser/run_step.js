// @ts-check
/** One step of some states, and the series of their orbits. */

import {BLOCK_ROWS, Integrator, X} from "../../../app/browser/modules/integrator.js"
import {input, module} from "./read_input.js"

const {system, states, gates, horizon} = input
const integrator = new Integrator(system, module)
const {lanes, order} = system.layout
/** @param {Float64Array} rows @param {number} first @param {number} count */
const read = (rows, first, count) =>
  Array.from({length: count}, (_, r) => Array.from(rows.subarray((first + r) * lanes, (first + r) * lanes + states.length)))
const withGate = (/** @type {[number, number, number]} */ gate) => ({gate})
integrator.prepare(system.layout.tolerance, horizon, gates.map(withGate))
states.forEach((/** @type {number[]} */ state, /** @type {number} */ i) => {
  state.forEach((value, row) => {
    integrator.now.rows[(X + row) * lanes + i] = value
    if (row < 4) integrator.starts[row * lanes + i] = value
  })
})
integrator.step(states.length)
integrator.jets(states.length)
const {rows, integers} = integrator.now
const flags = states.map((/** @type {any} */ _, /** @type {number} */ i) => [integers[2 * i], integers[2 * (lanes + i)]])
console.log(JSON.stringify({new: read(rows, X, BLOCK_ROWS - X), flags, jets: read(integrator.x.jet, 0, 2 * (order + 1))}))
