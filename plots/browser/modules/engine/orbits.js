// @ts-check
/** Orbits from t = 0 to a horizon, and their outcomes. */

/** Largest number of steps of all orbits together. */
const MOST_STEPS = 2 ** 31 - 1

/**
 * @typedef {import("./integrator.js").Integrator} Integrator
 * @typedef {import("./integrator.js").Numbers<"float64">} Floats
 * @typedef {ReturnType<typeof makeOrbits>} Orbits
 *
 * The outcomes of starts: fates, escape times in units of the well (NaN for orbits that stay), and numbers of crossings of the
 * section.
 *
 * @typedef {{fate: Int8Array, time: Float64Array, crossings: Uint16Array}} Ends
 */

/**
 * Return the arrays of orbits that kernels change, in the order of the kernels' parameters.
 *
 * @param {Integrator} integrator
 * @param {Floats} states  x, y, px, py of shape (n, 4)
 */
export function makeOrbits(integrator, states) {
  const [count] = states.shape
  const {notComputed} = integrator.system.layout.fates
  return {
    state: states,
    t: integrator.array("float64", [count]),
    crossings: integrator.array("int64", [count]),
    lastCrossings: integrator.array("int64", [count]),
    fate: integrator.array("int8", [count], new Int8Array(count).fill(notComputed)),
    pending: integrator.array("int8", [count], new Int8Array(count).fill(1)),
    remainder: integrator.array("float64", [count, 2]),
  }
}

/**
 * Propagate orbits to a horizon, in place, and return the number of steps.
 *
 * @param {Integrator} integrator
 * @param {Orbits} orbits
 * @param {import("./exits.js").Exits} exits
 * @param {import("./integrator.js").Numbers<"int64">} rows  row of each orbit's energy in the exits
 * @param {{horizon: number, tolerance: number, steps?: Floats}} options  `steps`, of shape (m, 5), takes the steps of one orbit
 */
export function propagate(integrator, orbits, exits, rows, {horizon, tolerance, steps}) {
  const {step, jets} = integrator.address
  const {lanesTogether} = integrator.system.layout
  const orbitIndices = integrator.integers(Array.from({length: orbits.t.shape[0]}, (_, orbit) => orbit))
  // A step of one orbit counts as the steps of all lanes that are computed together.
  const budget = steps ? lanesTogether * steps.shape[0] : MOST_STEPS
  const exitsAndOrbits = [exits.gates, exits.curves, rows, ...Object.values(orbits)]
  // The horizon is final: orbits that are still inside are bounded.
  const isFinal = 1
  // The kernel continues with any number of remaining orbits.
  const leastOrbits = 0
  const settings = [horizon, isFinal, tolerance, budget, leastOrbits]
  const trace = steps ?? integrator.array("float64", [0, 5])
  return integrator.call("propagate", step, jets, integrator.table, orbitIndices, ...settings, ...exitsAndOrbits, trace)
}

/**
 * Find the outcomes of starts inside all exits. Orbits that are still inside at the horizon are undecided.
 *
 * @param {Integrator} integrator
 * @param {import("./starts.js").Inside} inside
 * @param {import("./exits.js").Exits} exits
 * @param {{horizon: number, tolerance: number}} options
 * @param {import("./integrator.js").Numbers<"int8">} fate  of all starts; the fates of starts inside are written
 * @returns {Ends}
 */
export function findEnds(integrator, {kept, states, rows}, exits, options, fate) {
  const {shape} = fate
  const time = integrator.array("float64", shape, new Float64Array(shape[0]).fill(NaN))
  const crossings = integrator.array("float64", shape)
  integrator.temporarily(() => {
    const orbits = makeOrbits(integrator, states)
    propagate(integrator, orbits, exits, rows, options)
    integrator.call("report_ends", ...Object.values(orbits), kept, fate, time, crossings)
  })
  return {
    fate: Int8Array.from(fate.values),
    time: Float64Array.from(time.values),
    crossings: Uint16Array.from(crossings.values),
  }
}

/**
 * Find the outcomes of states, all of which are inside.
 *
 * @param {Integrator} integrator
 * @param {ArrayLike<number>} states  x, y, px, py of each start
 * @param {import("./exits.js").Exits} exits  at the energy of the states
 * @param {{horizon: number, tolerance: number}} options
 */
export function findAllEnds(integrator, states, exits, options) {
  const count = states.length / 4
  return integrator.temporarily(() => {
    const kept = integrator.integers(Array.from({length: count}, (_, orbit) => orbit))
    const inside = {kept, states: integrator.array("float64", [count, 4], states), rows: integrator.array("int64", [count])}
    return findEnds(integrator, inside, exits, options, integrator.array("int8", [count]))
  })
}
