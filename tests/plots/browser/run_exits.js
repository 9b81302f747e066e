// @ts-check
/** Points of the exits at some energies, the lines that the page draws there, and starts on the exits. */

import {exitLines} from "../../../plots/browser/modules/engine/curves.js"
import {Exits} from "../../../plots/browser/modules/engine/exits.js"
import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {drawStarts} from "../../../plots/browser/modules/engine/random_starts.js"
import {input, modules} from "./read_input.js"

const {system, energies, positions} = input
const integrator = new Integrator(system, modules)

/** @type {(exits: Exits) => unknown[]} */
const pointsOf = exits =>
  exits.list().map(exit => {
    if (!exit.isOpen) return positions.map(() => null)
    const [xs, ys] = exits.points(exit, positions)
    return xs.map((x, k) => [x, ys[k]])
  })

const found = energies.map((/** @type {number} */ each) => {
  const energy = each * system.units.energy
  const request = /** @type {any} */ ({where: "exits", count: 50, seed: 1})
  return {
    points: pointsOf(new Exits(integrator, [each])),
    lines: exitLines(integrator, energy),
    entrances: [...drawStarts(request, /** @type {any} */ ({energy}), integrator)],
  }
})
console.log(JSON.stringify(found))
