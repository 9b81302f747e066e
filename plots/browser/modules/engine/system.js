// @ts-check
/**
 * The data that the server sends for a potential, in units of the well. Values times `units`, powers of two, are in units of the
 * page.
 *
 * @typedef {object} System
 * @property {string} key  hash that is different for each system
 * @property {Layout} layout
 * @property {number[]} table  coefficients, in the form that the functions of the structure take
 * @property {number[] | null} backward  table of the system backward in time; null if it is the same table
 * @property {PolynomialTable | null} polynomial  V if it is a polynomial
 * @property {number} innerRadius  radius of the gap at the origin; 0 if the origin belongs to the well
 * @property {ExitData[]} exits  one for each outcome: exits over saddles, then circles
 * @property {number[][]} section  rows of numbers of the surface of section; none for y = 0, upward
 * @property {number[] | null} mirror  mirror image of each outcome under x → −x, after an entry 0; null without this symmetry
 * @property {{length: number, time: number, energy: number}} units
 * @property {number} numberDistance  of an exit, from the origin, as a share of the distance of the middle of the exit
 * @property {Slice} space  the plane of the positions
 * @property {Slice} surface  all directions of the velocity at all places, with the angle as a third axis
 * @property {Record<string, WindowTable>} windows  default windows of the slices, by their names
 *
 * V = Σ c x^i y^j, in the form that the test of the interior takes.
 *
 * @typedef {{powers: [number, number][], coefficients: number[], bernstein: number[][]}} PolynomialTable
 *
 * The constants of the kernels.
 *
 * @typedef {object} Layout
 * @property {number} order  of the series
 * @property {number} rows  numbers in the state of an orbit between two steps
 * @property {number} lanesTogether  smallest number of orbits (lanes) for which a step is computed
 * @property {number} tolerance  largest norm of the last coefficients of a step on the server
 * @property {number} beforeExit  time before the exit at which orbits at the edge of tubes start
 * @property {number} heap  address at which the start address of the free memory is stored
 * @property {string[]} functions  names of the functions of a system, in the order of their addresses
 * @property {Record<"bounded" | "notComputed", number>} fates
 * @property {ExitColumns} exits
 *
 * Number of columns of an exit, the column of its shape, and the codes of shapes.
 *
 * @typedef {{count: number, shape: number, shapes: Record<"closed" | "curve" | "line", number>}} ExitColumns
 *
 * @typedef {object} WindowTable
 * @property {number[]} energies  rising, in units of the page
 * @property {number[][]} windows  lowest and highest abscissa, lowest and highest ordinate
 *
 * @typedef {ExitTable | Circle} ExitData
 *
 * A circle at which orbits end: inside for a body, otherwise outside. Its numbers are in the form that kernels take.
 *
 * @typedef {{side: -1 | 1, radius: number, row: number[], gate: number[]}} Circle
 *
 * @typedef {object} ExitTable
 * @property {"curve" | "line"} shape  "line" in a rotating frame
 * @property {number} saddle  energy at which the exit opens
 * @property {number} highest  energy up to which the table is valid
 * @property {number[]} nodes  √(h − saddle) at which the curve is tabulated, rising
 * @property {number[][]} rows  for each node: gate, reach, origin, outward direction, middle, half width, slopes at both ends,
 *   and Chebyshev coefficients
 */

/**
 * The starts of a picture, in units of the well. Two coordinates vary along the axes, others are fixed. The energy determines a
 * momentum of the given sign, or the speed.
 *
 * @typedef {object} Slice
 * @property {[string, string]} axes  names
 * @property {[number, number]} units  of the axes in units of the page
 * @property {number[][]} motion  coordinates at the origin, then their changes per unit of each axis; the last is the energy
 * @property {number} decided  code of what the energy determines
 * @property {1 | -1} sign
 * @property {[number, number] | null} [sectionColumns]  columns of the axes in states, if the slice is on the section
 * @property {[boolean, boolean] | null} mirrored  whether each axis changes direction under x → −x; null without this symmetry
 */

/**
 * Return the system whose orbits, with reversed velocities, are the orbits of a system backward in time.
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
