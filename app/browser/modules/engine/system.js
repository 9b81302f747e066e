// @ts-check
/**
 * The data that the server sends with a potential. All of it is in units of the well; `units` converts from and to those of the
 * page, which are powers of two times as large.
 *
 * @typedef {object} System
 * @property {string} key  different for each system
 * @property {Layout} layout
 * @property {number[]} table  coefficients in the form that the functions of a structure take
 * @property {number[] | null} backward  table of the system backward in time; null for the same one
 * @property {PolynomialTable | null} polynomial  V; null for an expression
 * @property {number} innerRadius  radius of the gap at the origin; 0 for a well there
 * @property {ExitData[]} exits  one for each outcome: the exits of channels, then circles
 * @property {number[] | null} mirror  image of each outcome's number under x → −x; null without this symmetry
 * @property {{length: number, time: number, energy: number}} units
 * @property {Slice} space  the plane of the positions
 * @property {Slice} surface  all directions of the velocity at all places, with the angle as a third axis
 * @property {Record<string, WindowTable>} windows  default windows of the slices, by their names
 *
 * V = Σ c x^i y^j as the interior test takes it.
 *
 * @typedef {{powers: [number, number][], coefficients: number[], bernstein: number[][]}} PolynomialTable
 *
 * The constants of the kernels.
 *
 * @typedef {object} Layout
 * @property {number} order  order of the series
 * @property {number} rows  of the state of an orbit between two steps
 * @property {number} lanes_together  lanes that a step computes at least
 * @property {number} tolerance  of the steps that the server takes
 * @property {number} beforeExit  how long before they come to the exit orbits at the edge of tubes start
 * @property {number} heap  address of the address from which on memory is free
 * @property {string[]} functions  names of those of a structure, in the order of their addresses
 * @property {Record<"bounded" | "not_computed", number>} fates
 * @property {ExitColumns} exits
 *
 * Number of columns of an exit, that of its shape, and the values there.
 *
 * @typedef {{count: number, shape: number, shapes: Record<"closed" | "curve" | "line" | "disc" | "circle", number>}} ExitColumns
 *
 * @typedef {object} WindowTable
 * @property {number[]} energies  rising, in units of the page
 * @property {number[][]} windows  lowest and highest abscissa, lowest and highest ordinate
 *
 * @typedef {ExitTable | Circle} ExitData
 *
 * A circle at which orbits end: within it, as at a body, or beyond it; its numbers in the form that kernels take.
 *
 * @typedef {{side: -1 | 1, radius: number, row: number[], gate: number[]}} Circle
 *
 * @typedef {object} ExitTable
 * @property {"curve" | "line"} shape  a line in a frame that rotates
 * @property {number} saddle  energy at which the channel opens
 * @property {number} highest  energy up to which the table is valid
 * @property {number[]} nodes  √(h − saddle) at which the curve is tabulated, rising
 * @property {number[][]} rows  for each node: gate, reach, origin, outward direction, middle, half width, slopes at both ends, and
 *   Chebyshev coefficients
 */

/**
 * Which starts a picture holds, in units of the well: they move along two axes, other coordinates are fixed, and the energy decides
 * a momentum, which has the given sign, or the speed.
 *
 * @typedef {object} Slice
 * @property {[string, string]} axes  names
 * @property {[number, number]} units  the numbers by which those of the page are divided
 * @property {number[][]} motion  coordinates at the origin, then how far they move where an axis rises by 1; the last one is the energy
 * @property {number} decided  code of what the energy decides
 * @property {1 | -1} sign
 * @property {[boolean, boolean] | null} mirrored  whether each axis changes its direction under x → −x; null without this symmetry
 */

/**
 * The system whose orbits, with reversed velocities, are those of a system backward in time.
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
