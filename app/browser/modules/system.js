// @ts-check
/**
 * The data that the server sends with a potential. All of it is in units of the well; `units` converts from and to those of the
 * page, which are powers of two times as large.
 *
 * @typedef {object} System
 * @property {string} key  different for each system
 * @property {Layout} layout
 * @property {number[]} table  coefficients in the form that the functions of a structure take
 * @property {number | null} rotation  index of 2Ω in the table; null in a frame that does not rotate
 * @property {PolynomialTable | null} polynomial  V; null for an expression
 * @property {number} innerRadius  radius of the gap at the origin; 0 for a well there
 * @property {ExitData[]} exits  one for each outcome: the exits of channels, then circles
 * @property {number[] | null} mirror  image of each outcome's number under x → −x; null without this symmetry
 * @property {{length: number, time: number}} units
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
 * @property {number} heap  address of the address from which on memory is free
 * @property {string[]} functions  names of those of a structure, in the order of their addresses
 * @property {Record<"bounded" | "not_computed" | "failed" | "outside" | "forbidden", number>} fates
 * @property {ExitColumns} exits
 *
 * Columns of an exit, their number, and the values of that for its shape.
 *
 * @typedef {Record<"count" | "originX" | "originY" | "outwardX" | "outwardY" | "halfWidth" | "shape", number>
 *   & {shapes: Record<"closed" | "curve" | "line" | "disc" | "circle", number>}} ExitColumns
 *
 * @typedef {object} WindowTable
 * @property {number[]} energies  rising, in units of the page
 * @property {[number, number, number, number][]} windows  lowest and highest abscissa, lowest and highest ordinate
 *
 * @typedef {ExitTable | Circle} ExitData
 *
 * A circle at which orbits end: within it, as at a body, or beyond it.
 *
 * @typedef {{side: -1 | 1, x: number, y: number, radius: number}} Circle
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
 * a momentum, which has the given sign, or the speed v. h is that of the view if it is no axis.
 *
 * @typedef {"x" | "y" | "px" | "py" | "theta" | "beta" | "h"} Coordinate
 *
 * @typedef {object} Slice
 * @property {[string, string]} axes  names
 * @property {[number, number]} units  the numbers by which those of the page are divided
 * @property {[Move, Move]} moves
 * @property {Partial<Record<Coordinate, number>>} fixed
 * @property {"px" | "py" | "v"} decided
 * @property {1 | -1} sign
 * @property {[boolean, boolean] | null} mirrored  whether each axis changes its direction under x → −x; null without this symmetry
 *
 * How far a start moves along each coordinate where an axis rises by 1.
 *
 * @typedef {Partial<Record<Coordinate, number>>} Move
 *
 * A start with its energy, and with an angle that decides its momenta.
 *
 * @typedef {{x: number, y: number, px: number, py: number, h: number, theta: number, beta?: any}} Start
 */

/**
 * Whether the exits of a system are known at an energy in units of the well.
 *
 * @param {System} system
 * @param {number} energy
 */
export const coversEnergy = (system, energy) => system.exits.every(exit => "radius" in exit || energy <= exit.highest)

/**
 * The system whose orbits, with reversed velocities, are those of a system backward in time.
 *
 * @param {System} system
 * @returns {System}
 */
export const reversedInTime = system => ({
  ...system,
  table: system.table.map((value, entry) => (entry === system.rotation ? -value : value)),
})

/**
 * The default window at an energy, linear between tabulated ones; null beyond the table.
 *
 * @param {WindowTable | undefined} table
 * @param {number} energy  in units of the page
 * @returns {import("./slice.js").Window | null}
 */
export function windowAt(table, energy) {
  const above = table ? table.energies.findIndex(each => each >= energy) : -1
  if (!table || above < 0 || energy < table.energies[0]) return null
  const below = Math.max(above - 1, 0)
  const [low, high] = [table.energies[below], table.energies[above]]
  const share = high > low ? (energy - low) / (high - low) : 0
  const [xLow, xHigh, ordinateLow, ordinateHigh] = table.windows[below].map(
    (edge, k) => edge + share * (table.windows[above][k] - edge),
  )
  return {xLow, xHigh, ordinateLow, ordinateHigh}
}
