// @ts-check
/** States of orbits at times within steps, from the series of these. */

/**
 * x, y, px, py at some times after the beginnings of steps, each a row.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./integrator.js").Numbers<"float64">} series  (2, order + 1, steps) of x and y
 * @param {number[]} steps  the step of each time
 * @param {number[]} times
 */
export function evaluateSeries(integrator, series, steps, times) {
  return integrator.temporarily(() => {
    const [rows, states] = [integrator.array("int64", [times.length]), integrator.array("float64", [4, times.length])]
    steps.forEach((step, k) => (rows.values[2 * k] = step))
    integrator.call("evaluate_series", series, rows, integrator.array("float64", [times.length], times), states)
    return [0, 1, 2, 3].map(row => Float64Array.from(states.at(row).values))
  })
}
