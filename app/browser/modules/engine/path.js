// @ts-check
/** The path of a single orbit, for the card. */

import {Exits} from "./exits.js"
import {makeOrbits, propagate} from "./orbits.js"
import {findStarts, keepInside} from "./starts.js"

/**
 * @typedef {import("./integrator.js").Integrator} Integrator
 * @typedef {import("./integrator.js").Numbers<"float64">} Floats
 *
 * @typedef {object} Path
 * @property {number[]} x
 * @property {number[]} y
 * @property {number} channel  number of the exit, 0 if the orbit is inside at the end
 * @property {number} time  at the end, in units of the well
 * @property {number} crossings
 * @property {number} energy
 */

/** Number of points of the path in each step. */
const POINTS = 6
/** Number of steps in a call of the kernel. */
const PORTION = 512

/**
 * Return the path of the orbit of a point of a slice until its escape, but not beyond a duration in units of the well; null for a
 * start outside.
 *
 * @param {Integrator} integrator
 * @param {import("./system.js").Slice} slice
 * @param {number} energy  of all starts, unless the energy is an axis
 * @param {[number, number]} point
 * @param {number} duration
 * @returns {Path | null}
 */
export function findPath(integrator, slice, energy, point, duration) {
  return integrator.temporarily(() => {
    const starts = findStarts(integrator, slice, energy, integrator.array("float64", [2, 1], point))
    const [startEnergy] = starts.energies.values
    const exits = new Exits(integrator, [startEnergy])
    const {states} = keepInside(integrator, starts, exits, integrator.integers([0]), integrator.array("int8", [1]))
    return states.shape[0] ? follow(integrator, states, exits, startEnergy, duration) : null
  })
}

/**
 * Return the path of the orbit of a state inside all exits.
 *
 * @param {Integrator} integrator
 * @param {Floats} state  x, y, px, py of shape (1, 4); changed in place
 * @param {Exits} exits
 * @param {number} energy
 * @param {number} duration
 * @returns {Path}
 */
export function follow(integrator, state, exits, energy, duration) {
  const {address, table, system} = integrator
  const {fates, tolerance} = system.layout
  const [xs, ys] = [[state.values[0]], [state.values[1]]]
  const orbits = makeOrbits(integrator, state)
  const [row, steps] = [integrator.integers([0]), integrator.array("float64", [PORTION, 5])]
  const endTime = () => (orbits.fate.values[0] === fates.bounded ? duration : orbits.t.values[0])
  while (orbits.pending.values[0]) {
    const count = propagate(integrator, orbits, exits, row, {horizon: duration, tolerance, steps})
    const path = integrator.array("float64", [2, count * POINTS])
    integrator.call("sample_steps", address.jets, table, steps, count, endTime(), path)
    xs.push(...path.at(0).values)
    ys.push(...path.at(1).values)
  }
  const crossings = orbits.crossings.values[0] + orbits.lastCrossings.values[0]
  return {x: xs, y: ys, channel: Math.max(orbits.fate.values[0], 0), time: endTime(), crossings, energy}
}
