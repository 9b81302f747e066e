// @ts-check
/** Ends of orbits, found by the kernel that the server uses. */

/** Steps of lanes, at most. */
const MOST_STEPS = 2 ** 31 - 1
const MOST_CROSSINGS = 65535

/**
 * What is found of orbits: the exits through which they have left, at which times, and upward crossings of y = 0 until then.
 *
 * @typedef {object} Ends
 * @property {Int8Array} fate
 * @property {Float64Array} time  NaN for orbits that have not left
 * @property {Uint16Array} crossings
 */

/**
 * The arrays of orbits at t = 0 that the kernel changes, in its order.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Float64Array} states  x, y, px, py of each
 */
export function makeOrbits(integrator, states) {
  const count = states.length / 4
  const {not_computed} = integrator.system.layout.fates
  return {
    state: integrator.array("float64", [count, 4], states),
    t: integrator.array("float64", [count]),
    crossings: integrator.array("int64", [count]),
    lastCrossings: integrator.array("int64", [count]),
    fate: integrator.array("int8", [count], new Int8Array(count).fill(not_computed)),
    pending: integrator.array("int8", [count], new Int8Array(count).fill(1)),
    remainder: integrator.array("float64", [count, 2]),
  }
}

/**
 * Propagate orbits from t = 0; those still inside at the horizon stay undecided.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {Float64Array} states  x, y, px, py of each
 * @param {import("./exits.js").Exits} exits
 * @param {ArrayLike<number>} energyRows  of the energy of each orbit in `exits`; 0 for all if it is empty
 * @param {number} horizon
 * @param {number} tolerance
 * @returns {Ends}
 */
export function propagate(integrator, states, exits, energyRows, horizon, tolerance) {
  const count = states.length / 4
  const {address, table} = integrator
  const {fates} = integrator.system.layout
  return integrator.temporarily(() => {
    const orbits = makeOrbits(integrator, states)
    const [todo, rows] = [integrator.array("int64", [count]), integrator.array("int64", [count])]
    for (let orbit = 0; orbit < count; orbit++) {
      todo.values[2 * orbit] = orbit
      rows.values[2 * orbit] = energyRows[orbit] ?? 0
    }
    const steps = integrator.array("float64", [0, 5])
    const settings = [horizon, 1, tolerance, MOST_STEPS, 0]
    const [step, jets] = [address.step, address.jets]
    integrator.call(
      "propagate",
      step,
      jets,
      table,
      todo,
      ...settings,
      exits.gates,
      exits.curves,
      rows,
      ...Object.values(orbits),
      steps,
    )
    const [t, crossings, last] = [orbits.t.values, orbits.crossings.values, orbits.lastCrossings.values]
    const fate = Int8Array.from(orbits.fate.values, code => (code === fates.bounded ? fates.not_computed : code))
    return {
      fate,
      time: Float64Array.from(fate, (code, orbit) => (code > 0 ? t[orbit] : NaN)),
      crossings: Uint16Array.from(fate, (_, orbit) => Math.min(crossings[2 * orbit] + last[2 * orbit], MOST_CROSSINGS)),
    }
  })
}
