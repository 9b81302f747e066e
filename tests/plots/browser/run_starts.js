// @ts-check
/** Starts of points of slices with their energies, and default windows, in units of the page. */

import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {findStarts, windowAt} from "../../../plots/browser/modules/engine/starts.js"
import {input, modules} from "./read_input.js"

const {system, slices, energy, points, windows} = input
const integrator = new Integrator(system, modules)

const starts = slices.map((/** @type {import("../../../plots/browser/modules/engine/system.js").Slice} */ slice) => {
  const scaled = points.map((/** @type {number[]} */ along, /** @type {number} */ axis) =>
    along.map(value => value / slice.units[axis]),
  )
  const given = integrator.array("float64", [2, scaled[0].length], scaled.flat())
  const {states, energies} = findStarts(integrator, slice, energy / system.units.energy, given)
  return {states: [...states.values], energies: [...energies.values]}
})
console.log(JSON.stringify({starts, windows: windows.map((/** @type {number} */ each) => windowAt(integrator, "x_px", each))}))
