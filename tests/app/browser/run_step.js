// @ts-check
/** The first steps of some orbits, their crossings, and the series of the first step of each. */

import {Exits} from "../../../app/browser/modules/exits.js"
import {Integrator} from "../../../app/browser/modules/integrator.js"
import {makeOrbits} from "../../../app/browser/modules/propagate.js"
import {input, modules} from "./read_input.js"

const {system, states, energy, horizon, count} = input
const integrator = new Integrator(system, modules)
const {address, table} = integrator
const exits = new Exits(integrator, [energy])
const {order, tolerance, lanes_together} = system.layout
const [start, series] = [integrator.array("float64", [4, 2]), integrator.array("float64", [2, order + 1, 2])]

const found = states.map((/** @type {number[]} */ state) => {
  const [zeros, steps] = [integrator.array("int64", [1]), integrator.array("float64", [count, 5])]
  const orbits = makeOrbits(integrator, Float64Array.from(state))
  const settings = [horizon, 1, tolerance, lanes_together * count, 0]
  const [step, jets] = [address.step, address.jets]
  const all = [exits.gates, exits.curves, zeros, ...Object.values(orbits), steps]
  const taken = integrator.call("propagate", step, jets, table, zeros, ...settings, ...all)
  state.forEach((value, row) => (start.values[2 * row] = value))
  integrator.call("compute_series", jets, table, start, series)
  return {
    steps: [...steps.values],
    taken,
    crossings: orbits.crossings.values[0],
    series: [...series.values].filter((_, k) => k % 2 === 0),
  }
})
console.log(JSON.stringify(found))
