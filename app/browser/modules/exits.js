// @ts-check
/** Exits at some energies as the kernels take them, see `engine/integrator/kernels/events.py`, and their points. */

/**
 * An exit at one energy.
 *
 * @typedef {object} Exit
 * @property {number} number
 * @property {boolean} isOpen
 * @property {boolean} isCircle  within or beyond which orbits end
 * @property {boolean} returns  whether an orbit can pass it and return
 * @property {[number, number]} outward  of an exit over a saddle
 * @property {number} halfWidth
 */

export class Exits {
  /**
   * The exits of a system at some energies, in units of the well. Their memory is that of the integrator.
   *
   * @param {import("./integrator.js").Integrator} integrator
   * @param {ArrayLike<number>} energies
   */
  constructor(integrator, energies) {
    const {exits, layout} = integrator.system
    this.#integrator = integrator
    this.#columns = layout.exits
    this.count = exits.length
    const shape = [energies.length, exits.length]
    /** Of each energy, (energies, exits, columns). */
    this.curves = integrator.array("float64", [...shape, layout.exits.count])
    /** Of all energies, (exits, 3). */
    this.gates = integrator.array("float64", [exits.length, 3])
    exits.forEach((exit, k) => ("radius" in exit ? this.#placeCircle(exit, k) : this.#interpolate(exit, k, energies)))
  }

  #integrator
  #columns

  /**
   * @param {import("./system.js").Circle} circle
   * @param {number} k
   */
  #placeCircle({side, x, y, radius}, k) {
    const {originX, originY, halfWidth, shape, shapes} = this.#columns
    for (let row = 0; row < this.curves.shape[0]; row++) {
      const curve = this.curves.at(row).at(k).values
      curve[originX] = x
      curve[originY] = y
      curve[halfWidth] = radius
      curve[shape] = side < 0 ? shapes.disc : shapes.circle
    }
    this.gates.at(k).values.set([x, y, radius])
  }

  /**
   * The gate is the one that is inside the exits at all energies.
   *
   * @param {Pick<import("./system.js").ExitTable, "shape" | "saddle">} table
   * @param {number} k
   * @param {ArrayLike<number>} energies
   */
  #interpolate({shape, saddle}, k, energies) {
    const integrator = this.#integrator
    const gates = this.gates.at(k)
    gates.values[2] = Infinity
    integrator.temporarily(() => {
      const table = integrator.exitTables[k] ?? []
      const code = this.#columns.shapes[shape]
      const gate = integrator.array("float64", [3])
      for (let row = 0; row < energies.length; row++) {
        const place = Math.sqrt(Math.max(energies[row] - saddle, 0))
        gate.values.fill(0)
        integrator.call("interpolate_exit", ...table, place, code, this.curves.at(row).at(k), gate)
        if (row === 0 || gate.values[2] < gates.values[2]) gates.values.set(gate.values)
      }
    })
  }

  /**
   * The exits at one of the energies.
   *
   * @param {number} [row]
   * @returns {Exit[]}
   */
  list(row = 0) {
    const {shape, shapes, outwardX, outwardY, halfWidth} = this.#columns
    return Array.from({length: this.count}, (_, k) => {
      const curve = this.curves.at(row).at(k).values
      return {
        number: k + 1,
        isOpen: curve[shape] !== shapes.closed,
        isCircle: curve[shape] >= shapes.disc,
        returns: curve[shape] >= shapes.line,
        outward: [curve[outwardX], curve[outwardY]],
        halfWidth: curve[halfWidth],
      }
    })
  }

  /**
   * x and y of points of an exit at the first energy, at s from −1 to 1; around a circle s goes from −1 to 1, too.
   *
   * @param {{number: number}} exit
   * @param {number[]} positions
   * @returns {[number[], number[]]}
   */
  points({number}, positions) {
    const integrator = this.#integrator
    return integrator.temporarily(() => {
      const points = integrator.array("float64", [2, positions.length])
      const places = integrator.array("float64", [positions.length], positions)
      integrator.call("exit_points", this.curves.at(0).at(number - 1), places, points)
      return [Array.from(points.at(0).values), Array.from(points.at(1).values)]
    })
  }
}
