// @ts-check
/** Exits at given energies, in the form that kernels take (`engine/integrator/kernels/exit_geometry.py`), and points on them. */

/**
 * An exit at one energy.
 *
 * @typedef {object} Exit
 * @property {number} number  from 1
 * @property {boolean} isOpen
 * @property {boolean} isCircle  whether the exit is a circle, not a curve over a saddle
 */

export class Exits {
  /**
   * Tabulate the exits of a system at given energies, in units of the well, in the memory of the integrator.
   *
   * @param {import("./integrator.js").Integrator} integrator
   * @param {ArrayLike<number>} energies
   */
  constructor(integrator, energies) {
    const {exits, layout, section} = integrator.system
    this.#integrator = integrator
    this.#columns = layout.exits
    /** Values of the exits at each energy, of shape (energies, exits, columns). */
    this.curves = integrator.array("float64", [energies.length, exits.length, layout.exits.count])
    /** Values of the exits at all energies, and the rows of the section, of shape (exits + rows, 3). */
    this.gates = integrator.array("float64", [exits.length + section.length, 3])
    section.forEach((row, index) => this.gates.at(exits.length + index).values.set(row))
    exits.forEach((exit, index) => ("row" in exit ? this.#setCircle(exit, index) : this.#interpolate(exit, index, energies)))
  }

  #integrator
  #columns

  /**
   * Set the values of a circle, which are the same at all energies.
   *
   * @param {import("./system.js").Circle} circle
   * @param {number} index  of the exit
   */
  #setCircle({row, gate}, index) {
    for (let energyRow = 0; energyRow < this.curves.shape[0]; energyRow++) this.curves.at(energyRow).at(index).values.set(row)
    this.gates.at(index).values.set(gate)
  }

  /**
   * Set the values of an exit over a saddle.
   *
   * @param {import("./system.js").ExitTable} table
   * @param {number} index  of the exit
   * @param {ArrayLike<number>} energies
   */
  #interpolate({shape, saddle}, index, energies) {
    const integrator = this.#integrator
    const table = integrator.exitTables[index] ?? []
    integrator.temporarily(() => {
      const energyArray = integrator.array("float64", [energies.length], energies)
      const code = this.#columns.shapes[shape]
      integrator.call("interpolate_exit", ...table, saddle, code, energyArray, index, this.curves, this.gates)
    })
  }

  /** Return the exits at the first energy. @returns {Exit[]} */
  list() {
    const {shape, shapes} = this.#columns
    return this.#integrator.system.exits.map((exit, index) => ({
      number: index + 1,
      isOpen: this.curves.at(0).at(index).values[shape] !== shapes.closed,
      isCircle: "row" in exit,
    }))
  }

  /**
   * Return x and y of points of an exit at the first energy. Positions go from −1 to 1 along an exit, or once around a circle.
   *
   * @param {{number: number}} exit
   * @param {number[]} positions
   * @returns {[number[], number[]]}
   */
  points({number}, positions) {
    const integrator = this.#integrator
    return integrator.temporarily(() => {
      const points = integrator.array("float64", [2, positions.length])
      const positionArray = integrator.array("float64", [positions.length], positions)
      integrator.call("exit_points", this.curves.at(0).at(number - 1), positionArray, points)
      return [Array.from(points.at(0).values), Array.from(points.at(1).values)]
    })
  }
}
