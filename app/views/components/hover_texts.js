// @ts-check
import {number} from "../../browser/modules/numbers.js"

/**
 * Texts at the mouse, for Bokeh's hover tools; see `app/browser/javascript.py`.
 *
 * @typedef {Record<string, any>} Columns
 */

/**
 * How the orbit of a pixel ends; "ends" are the words of a map on the codes that follow those of the names.
 *
 * @param {number} code
 * @param {string[]} names
 * @param {Columns} columns
 * @returns {string}
 */
export function fateName(code, names, {ends}) {
  return names[code] || ends?.[0][code - names.length] || names[0]
}

/**
 * What is known of a pixel, in lines. Columns of layers that are off, and of maps that they are not computed for, have other sizes.
 *
 * @param {number} pixel
 * @param {{maps: Columns, compared: Columns}} columns  of the pictures, and of the other view
 * @param {{bounded: number, first: number, firstEvidence: number}} codes  the first of each kind
 * @param {{evidence: string[], layers: Record<string, string[]>, values: Record<string, string>, fates: string[]}} words  by code;
 *   those of the layers by their columns, empty if the map has its own, and what the numbers in other columns of layers are
 */
export function pixelDetails(pixel, {maps, compared}, codes, words) {
  const fates = maps.fate[0]
  const fate = fates[pixel]
  if (fate < codes.bounded) return ""
  const known = (/** @type {any} */ image) => (image?.length === fates.length ? image[pixel] : undefined)
  const time = maps.escape_time[0][pixel]
  const crossings = maps.crossings[0][pixel]
  const lines = [
    Number.isFinite(time) && `escape time ${number(time)}`,
    fate > codes.bounded
      ? `${crossings} upward ${crossings === 1 ? "crossing" : "crossings"} of y = 0`
      : words.evidence[maps.crossing_class[0][pixel] - codes.firstEvidence],
    ...Object.entries(words.layers).map(([column, sentences]) => {
      const ofMap = sentences.length ? sentences : maps[`${column}_words`][0]
      return ofMap[known(maps[column][0])]
    }),
    ...Object.entries(words.values).map(
      ([column, name]) => Number.isFinite(known(maps[column][0])) && `${name} ${number(known(maps[column][0]))}`,
    ),
    known(maps.difference[0]) >= codes.first &&
      isSamePlace(maps, compared) &&
      `other view: ${fateName(known(compared.fate[0]), words.fates, compared)}`,
  ]
  return lines.filter(line => line).join("\n")
}

/** Whether two images have the same window. @type {(one: Columns, other: Columns) => boolean} */
function isSamePlace(one, other) {
  return ["x", "y", "dw", "dh"].every(name => one[name][0] === other[name][0])
}

/**
 * A coordinate with enough decimals to distinguish neighbouring pixels.
 *
 * @param {number} value
 * @param {{start: number, end: number}} range
 */
export function coordinate(value, range) {
  const decimals = Math.min(Math.max(Math.ceil(3 - Math.log10(range.end - range.start)), 2), 17)
  return value.toFixed(decimals)
}
