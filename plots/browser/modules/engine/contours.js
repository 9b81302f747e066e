// @ts-check
/** Level lines of a function on a rectangle, found by marching squares. */

/** Number of samples along a side. Between samples, the function is interpolated linearly. */
export const SAMPLES = 101

/**
 * Values of a function on a grid of `SAMPLES` × `SAMPLES` points over a window, in which lines of any level can be found.
 *
 * @typedef {object} Grid
 * @property {import("./starts.js").Window} window
 * @property {Float64Array} values  row by row
 */

/**
 * Find the lines on which the function has a level.
 *
 * @param {Grid} grid
 * @param {number} level
 * @returns {{xs: number[], ys: number[]}[]}
 */
export function levelLines({window, values}, level) {
  /** Neighbours of each crossed edge on its line. The edge to the right of sample k has number 2k, the upward edge 2k + 1. */
  const neighbours = /** @type {Map<number, number[]>} */ (new Map())
  const join = (/** @type {number} */ one, /** @type {number} */ other) => {
    for (const [from, to] of [
      [one, other],
      [other, one],
    ])
      neighbours.set(from, [...(neighbours.get(from) ?? []), to])
  }
  for (let row = 0; row < SAMPLES - 1; row++) {
    for (let column = 0; column < SAMPLES - 1; column++) joinCell(values, level, row * SAMPLES + column, join)
  }
  const pointOn = (/** @type {number} */ edge) => edgePoint(window, values, level, edge)
  const lines = followLines(neighbours).map(edges => edges.map(pointOn))
  return lines.map(line => ({xs: line.map(([x]) => x), ys: line.map(([, y]) => y)}))
}

/**
 * Join the crossed edges of the cell above and to the right of a sample.
 *
 * @param {Float64Array} values
 * @param {number} level
 * @param {number} corner  index of the sample
 * @param {(one: number, other: number) => void} join
 */
function joinCell(values, level, corner, join) {
  const isInside = (/** @type {number} */ sample) => values[sample] <= level
  const [right, opposite, above] = [corner + 1, corner + SAMPLES + 1, corner + SAMPLES]
  const first = isInside(corner)
  // Nearly all cells have no crossed edge.
  if (isInside(right) === first && isInside(opposite) === first && isInside(above) === first) return
  const inside = [corner, right, opposite, above].map(isInside)
  // The edges from each corner to the next, counterclockwise.
  const sides = [2 * corner, 2 * (corner + 1) + 1, 2 * (corner + SAMPLES), 2 * corner + 1]
  const crossed = sides.filter((_, k) => inside[k] !== inside[(k + 1) % 4])
  // A cell at a saddle has four crossed edges, and two lines.
  for (let k = 0; k < crossed.length; k += 2) join(crossed[k], crossed[k + 1])
}

/**
 * Return the point of an edge at which the function has the level.
 *
 * @param {import("./starts.js").Window} window
 * @param {Float64Array} values
 * @param {number} level
 * @param {number} edge  number of the edge, see `levelLines`
 * @returns {[number, number]}
 */
function edgePoint(window, values, level, edge) {
  const from = edge >> 1
  const isUpward = (edge & 1) === 1
  const to = from + (isUpward ? SAMPLES : 1)
  const share = (level - values[from]) / (values[to] - values[from])
  const column = (from % SAMPLES) + (isUpward ? 0 : share)
  const row = Math.floor(from / SAMPLES) + (isUpward ? share : 0)
  const scale = 1 / (SAMPLES - 1)
  return [
    window.xLow + (window.xHigh - window.xLow) * column * scale,
    window.ordinateLow + (window.ordinateHigh - window.ordinateLow) * row * scale,
  ]
}

/**
 * Return the edges of each line in order, first of lines with ends, then of closed lines. This empties the map of neighbours.
 *
 * @param {Map<number, number[]>} neighbours  of each crossed edge
 * @returns {number[][]}
 */
function followLines(neighbours) {
  const lines = []
  const ends = [...neighbours.keys()].filter(edge => neighbours.get(edge)?.length === 1)
  for (const first of [...ends, ...neighbours.keys()]) {
    if (!neighbours.has(first)) continue
    const line = [first]
    const isClosed = neighbours.get(first)?.length === 2
    /** @type {number | undefined} */
    let edge = first
    while (edge !== undefined) {
      /** @type {number | undefined} */
      const next = neighbours.get(edge)?.find(other => neighbours.has(other) && other !== line[line.length - 2])
      neighbours.delete(edge)
      if (next !== undefined) line.push(next)
      edge = next
    }
    if (isClosed) line.push(first)
    lines.push(line)
  }
  return lines
}
