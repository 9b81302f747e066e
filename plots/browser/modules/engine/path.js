// @ts-check
/** The path of the orbit under the pointer, for its card. */

import {Exits} from "./exits.js"
import {makeOrbits, propagate} from "./orbits.js"
import {findStarts, keepInside} from "./starts.js"

/**
 * @typedef {import("./integrator.js").Integrator} Integrator
 * @typedef {import("./integrator.js").Numbers<"float64">} Floats
 *
 * @typedef {object} Path  in units of the well
 * @property {number[]} x
 * @property {number[]} y
 * @property {number} channel  number of the exit; 0 for an orbit that has not escaped
 * @property {number} time  of the last point
 * @property {number} crossings  crossings of the section
 * @property {number} energy
 */

/** Number of points of the path in each step. */
const POINTS_PER_STEP = 6
/** Largest number of steps in one call of the kernel. */
const STEPS_PER_CALL = 512

/**
 * Return the path of the orbit that starts at a point of a slice. The path ends at the escape, or after a duration. The result is
 * null for a start that is forbidden or beyond an exit.
 *
 * @param {Integrator} integrator
 * @param {import("./system.js").Slice} slice
 * @param {number} energy  in units of the well; ignored if the energy is an axis
 * @param {[number, number]} point  in units of the well
 * @param {number} duration  in units of the well
 * @returns {Path | null}
 */
export function findPath(integrator, slice, energy, point, duration) {
  return integrator.temporarily(() => {
    const starts = findStarts(integrator, slice, energy, integrator.array("float64", [2, 1], point))
    const [startEnergy] = starts.energies.values
    const exits = new Exits(integrator, [startEnergy])
    const [energyRow, unusedFate] = [integrator.integers([0]), integrator.array("int8", [1])]
    const {states} = keepInside(integrator, starts, exits, energyRow, unusedFate)
    return states.shape[0] ? followOrbit(integrator, states, exits, startEnergy, duration) : null
  })
}

/**
 * Return the path of the orbit that starts at a state inside all exits. The path ends at the escape, or after a duration.
 *
 * @param {Integrator} integrator
 * @param {Floats} state  x, y, px, py of shape (1, 4); changed in place
 * @param {Exits} exits
 * @param {number} energy
 * @param {number} duration  in units of the well
 * @returns {Path}
 */
export function followOrbit(integrator, state, exits, energy, duration) {
  const {address, table, system} = integrator
  const {fates, tolerance} = system.layout
  const [xs, ys] = [[state.values[0]], [state.values[1]]]
  const orbits = makeOrbits(integrator, state)
  const [energyRow, steps] = [integrator.integers([0]), integrator.array("float64", [STEPS_PER_CALL, 5])]
  const endTime = () => (orbits.fate.values[0] === fates.bounded ? duration : orbits.t.values[0])
  while (orbits.pending.values[0]) {
    const count = propagate(integrator, orbits, exits, energyRow, {horizon: duration, tolerance, steps})
    const points = integrator.array("float64", [2, count * POINTS_PER_STEP])
    integrator.call("sample_steps", address.jets, table, steps, count, endTime(), points)
    xs.push(...points.at(0).values)
    ys.push(...points.at(1).values)
  }
  const crossings = orbits.crossings.values[0] + orbits.lastCrossings.values[0]
  return {x: xs, y: ys, channel: Math.max(orbits.fate.values[0], 0), time: endTime(), crossings, energy}
}
