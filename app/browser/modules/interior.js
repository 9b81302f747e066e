// @ts-check
/** Which starts lie beyond an exit; see `engine/integrator/kernels/interior.py`. */

/**
 * The number of an exit for each start beyond one, 0 for starts inside and in the forbidden region.
 *
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./exits.js").Exits} exits
 * @param {ArrayLike<number>} states  x, y, px, py of each start
 * @param {ArrayLike<number>} energies
 * @param {ArrayLike<number>} [rows]  of their energies in `exits`; 0 for all if left out
 * @returns {Int8Array}
 */
export function findOutside(integrator, exits, states, energies, rows = []) {
  const {polynomial, address, table, system} = integrator
  const count = energies.length
  return integrator.temporarily(() => {
    const [x, y] = [integrator.array("float64", [count]), integrator.array("float64", [count])]
    const [row, outside] = [integrator.array("int64", [count]), integrator.array("int8", [count])]
    const points = [x, y, integrator.array("float64", [count], energies), exits.curves, row, outside]
    const [xs, ys, places] = [x.values, y.values, row.values]
    for (let start = 0; start < count; start++) {
      xs[start] = states[4 * start]
      ys[start] = states[4 * start + 1]
      places[2 * start] = rows[start] ?? 0
    }
    if (polynomial) integrator.call("find_outside_polynomial", ...polynomial, ...points)
    else integrator.call("find_outside", address.potential_slopes, table, system.innerRadius, ...points)
    return Int8Array.from(outside.values)
  })
}
