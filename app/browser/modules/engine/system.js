// @ts-check
/**
 * The data that the server sends with a potential, in units of the well. `units` converts to units of the page, which are larger
 * by powers of two.
 *
 * @typedef {object} System
 * @property {string} key  different for each system
 * @property {Layout} layout
 * @property {number[]} table  coefficients in the form that the functions of a structure take
 * @property {number[] | null} backward  table of the system backward in time; null if it is the same
 * @property {PolynomialTable | null} polynomial  V; null for an expression
 * @property {number} innerRadius  radius of the gap at the origin; 0 if the origin belongs to the well
 * @property {ExitData[]} exits  one for each outcome: the exits of channels, then circles
 * @property {number[] | null} mirror  for each outcome, the number of its mirror image under x → −x; null without this symmetry
 * @property {{length: number, time: number, energy: number}} units
 * @property {Slice} space  the plane of the positions
 * @property {Slice} surface  all directions of the velocity at all places, with the angle as a third axis
 * @property {Record<string, WindowTable>} windows  default windows of the slices, by their names
 *
 * V = Σ c x^i y^j in the form that the interior test takes.
 *
 * @typedef {{powers: [number, number][], coefficients: number[], bernstein: number[][]}} PolynomialTable
 *
 * The constants of the kernels.
 *
 * @typedef {object} Layout
 * @property {number} order  order of the series
 * @property {number} rows  of the state of an orbit between two steps
 * @property {number} lanes_together  smallest number of lanes that a step computes
 * @property {number} tolerance  tolerance of the steps on the server
 * @property {number} beforeExit  time before the exit at which orbits at the edge of tubes start
 * @property {number} heap  address at which the start address of the free memory is stored
 * @property {string[]} functions  names of the functions of a structure, in the order of their addresses
 * @property {Record<"bounded" | "not_computed", number>} fates
 * @property {ExitColumns} exits
 *
 * Number of columns of an exit, column of its shape, and the values of this column.
 *
 * @typedef {{count: number, shape: number, shapes: Record<"closed" | "curve" | "line" | "disc" | "circle", number>}} ExitColumns
 *
 * @typedef {object} WindowTable
 * @property {number[]} energies  rising, in units of the page
 * @property {number[][]} windows  lowest and highest abscissa, lowest and highest ordinate
 *
 * @typedef {ExitTable | Circle} ExitData
 *
 * A circle at which orbits end: inside it for a body, or outside it. Its numbers are in the form that kernels take.
 *
 * @typedef {{side: -1 | 1, radius: number, row: number[], gate: number[]}} Circle
 *
 * @typedef {object} ExitTable
 * @property {"curve" | "line"} shape  a line in a rotating frame
 * @property {number} saddle  energy at which the exit opens
 * @property {number} highest  energy up to which the table is valid
 * @property {number[]} nodes  √(h − saddle) at which the curve is tabulated, rising
 * @property {number[][]} rows  for each node: gate, reach, origin, outward direction, middle, half width, slopes at both ends, and
 *   Chebyshev coefficients
 */

/**
 * The starts of a picture, in units of the well. They move along two axes, other coordinates are fixed, and the energy determines
 * a momentum, which has the given sign, or the speed.
 *
 * @typedef {object} Slice
 * @property {[string, string]} axes  names
 * @property {[number, number]} units  the numbers by which numbers of the page are divided
 * @property {number[][]} motion  coordinates at the origin, then how far they move where an axis rises by 1; the last one is the energy
 * @property {number} decided  code of what the energy determines
 * @property {1 | -1} sign
 * @property {[boolean, boolean] | null} mirrored  whether each axis changes its direction under x → −x; null without this symmetry
 */

/**
 * Return the system whose orbits, with reversed velocities, are those of a system backward in time.
 *
 * @param {System} system
 * @returns {System}
 */
export const reversedInTime = system => ({...system, table: system.backward ?? system.table})

/**
 * Whether the exits of a system are known at an energy in units of the well.
 *
 * @param {System} system
 * @param {number} energy
 */
export const coversEnergy = (system, energy) => system.exits.every(exit => "row" in exit || energy <= exit.highest)
