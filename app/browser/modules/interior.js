// @ts-check
/** Which starts lie beyond an exit; see `engine/integrator/kernels/interior.py`. */

export class OutsideTest {
  /**
   * A test of as many starts at a time, whose memory is that of the integrator.
   *
   * @param {import("./integrator.js").Integrator} integrator
   * @param {import("./exits.js").Exits} exits
   * @param {number} count
   */
  constructor(integrator, exits, count) {
    const {polynomial, address, table, system} = integrator
    this.#integrator = integrator
    this.#x = integrator.array("float64", [count])
    this.#y = integrator.array("float64", [count])
    this.#energies = integrator.array("float64", [count])
    this.#rows = integrator.array("int64", [count])
    this.#outside = integrator.array("int8", [count])
    const points = [this.#x, this.#y, this.#energies, exits.curves, this.#rows, this.#outside]
    this.#kernel = polynomial ? "find_outside_polynomial" : "find_outside"
    const potential = polynomial ?? [address.potential_slopes, table, system.innerRadius]
    this.#passed = [...potential, ...points]
  }

  #integrator
  #x
  #y
  #energies
  #rows
  #outside
  #kernel
  #passed

  /**
   * The number of an exit for each start beyond one, 0 for starts inside and in the forbidden region; until the next call.
   *
   * @param {ArrayLike<number>} states  x, y, px, py of each start
   * @param {ArrayLike<number>} energies
   * @param {ArrayLike<number>} [rows]  of their energies in the exits; 0 for all if left out
   */
  find(states, energies, rows = []) {
    const [xs, ys, places] = [this.#x.values, this.#y.values, this.#rows.values]
    for (let start = 0; start < energies.length; start++) {
      xs[start] = states[4 * start]
      ys[start] = states[4 * start + 1]
      places[2 * start] = rows[start] ?? 0
    }
    this.#energies.values.set(energies)
    const outside = this.#outside.values
    outside.fill(0)
    this.#integrator.call(this.#kernel, ...this.#passed)
    return outside
  }
}
