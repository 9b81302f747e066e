// @ts-check
/** The first steps of some orbits, their crossings, and the series of the first step of each. */

import {Exits} from "../../../plots/browser/modules/engine/exits.js"
import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {makeOrbits, propagate} from "../../../plots/browser/modules/engine/orbits.js"
import {input, modules} from "./read_input.js"

const {system, states, energy, horizon, count} = input
const integrator = new Integrator(system, modules)
const exits = new Exits(integrator, [energy])
const {order, tolerance} = system.layout
const [start, series] = [integrator.array("float64", [4, 2]), integrator.array("float64", [2, order + 1, 2])]

const found = states.map((/** @type {number[]} */ state) => {
  const steps = integrator.array("float64", [count, 5])
  const orbits = makeOrbits(integrator, integrator.array("float64", [1, 4], state))
  const taken = propagate(integrator, orbits, exits, integrator.integers([0]), {horizon, tolerance, steps})
  state.forEach((value, row) => (start.values[2 * row] = value))
  integrator.call("compute_series", integrator.address.jets, integrator.table, start, series)
  return {
    steps: [...steps.values],
    taken,
    crossings: orbits.crossings.values[0],
    series: [...series.values].filter((_, k) => k % 2 === 0),
  }
})
console.log(JSON.stringify(found))
