// @ts-check
import {number} from "../../../plots/browser/modules/numbers.js"

/**
 * Texts of Bokeh's hover tools; `app/browser/javascript.py` makes callbacks of these functions.
 *
 * @typedef {Record<string, any>} Columns
 */

/**
 * Return how the orbit of a pixel ends. For codes beyond the names, the column "ends" of the map has the words.
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
 * Return what is known of a pixel, in lines. The column of a layer that is off or not computed has another size than the map.
 *
 * @param {number} pixel
 * @param {{maps: Columns, compared: Columns}} columns  of the maps, and of the map of the other view
 * @param {{bounded: number, firstDifference: number, firstEvidence: number}} codes  of bounded orbits, first difference, first evidence
 * @param {{evidence: string[], layers: Record<string, string[]>, values: Record<string, string>, fates: string[]}} words
 *   of evidence and fates, by code; of layers, by column and code, or empty if the map has its own words; of numbers, by column
 */
export function pixelDetails(pixel, {maps, compared}, codes, words) {
  const fates = maps.fate[0]
  const fate = fates[pixel]
  if (fate < codes.bounded) return ""
  const valueIn = (/** @type {any} */ image) => (image?.length === fates.length ? image[pixel] : undefined)
  const time = maps.escape_time[0][pixel]
  const crossings = maps.crossings[0][pixel]
  const lines = [
    Number.isFinite(time) && `escape time ${number(time)}`,
    fate > codes.bounded
      ? `${crossings} ${maps.crossing_words[0][crossings === 1 ? 0 : 1]}`
      : words.evidence[maps.crossing_class[0][pixel] - codes.firstEvidence],
    ...Object.entries(words.layers).map(([column, sentences]) => {
      const layerWords = sentences.length ? sentences : maps[`${column}_words`][0]
      return layerWords[valueIn(maps[column][0])]
    }),
    ...Object.entries(words.values).map(
      ([column, name]) => Number.isFinite(valueIn(maps[column][0])) && `${name} ${number(valueIn(maps[column][0]))}`,
    ),
    valueIn(maps.difference[0]) >= codes.firstDifference &&
      isSamePlace(maps, compared) &&
      `other view: ${fateName(valueIn(compared.fate[0]), words.fates, compared)}`,
  ]
  return lines.filter(line => line).join("\n")
}

/** Whether two images have the same window. @type {(one: Columns, other: Columns) => boolean} */
function isSamePlace(one, other) {
  return ["x", "y", "dw", "dh"].every(name => one[name][0] === other[name][0])
}

/**
 * Write a coordinate with enough decimals to distinguish neighbouring pixels.
 *
 * @param {number} value
 * @param {{start: number, end: number}} range
 */
export function coordinate(value, range) {
  const decimals = Math.min(Math.max(Math.ceil(3 - Math.log10(range.end - range.start)), 2), 17)
  return value.toFixed(decimals).replace("-", "−")
}
