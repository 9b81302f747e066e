// @ts-check
/** Points of the exits at some energies, the lines that the page draws there, and starts on the exits. */

import {exitLines} from "../../../app/browser/modules/curves.js"
import {randomNumbers} from "../../../app/browser/modules/ensemble_starts.js"
import {drawEntrances} from "../../../app/browser/modules/exit_starts.js"
import {Exits} from "../../../app/browser/modules/exits.js"
import {Integrator} from "../../../app/browser/modules/integrator.js"
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

const found = energies.map((/** @type {number} */ energy) => {
  const exits = new Exits(integrator, [energy])
  const entrances = drawEntrances(50, integrator, exits, energy, randomNumbers(1))
  return {
    points: pointsOf(exits),
    lines: exitLines(integrator, energy * (system.units.length / system.units.time) ** 2),
    entrances: [...entrances],
  }
})
console.log(JSON.stringify(found))
