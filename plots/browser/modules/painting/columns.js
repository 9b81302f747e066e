// @ts-check
/**
 * The pixel codes of outcomes and classes, which the server sends (`app/views/panels/engine_component.py`).
 *
 * @typedef {object} Coding
 * @property {[number, number][]} outcomes  fate and code of the outcomes that are not escapes
 * @property {number} firstClass  code of the first end, and of the first class of crossings
 * @property {number[]} ends  place of each outcome, from fate 1, among all ends
 * @property {string[]} words  descriptions of all ends
 * @property {number[]} leastCrossings  fewest crossings of each class
 * @property {[string, string]} crossingWords  words for one crossing and for several
 * @property {number} undecided  code of undecided pixels
 * @property {number[][]} differences  code of the difference of two pixels, by the codes of both
 * @property {string[]} layers  columns of layers, which only the server computes
 *
 * @typedef {Record<string, any[]>} Columns  of a data source of Bokeh
 */

import {energyAxis} from "../engine/starts.js"

/**
 * Return the columns of the maps for the pixels of a view, in the form of the server.
 *
 * @param {Coding} coding
 * @param {import("../engine/pixels.js").View} view
 * @param {import("../engine/pixels.js").Pixels} pixels
 * @param {Columns} serverColumns  columns from the server, whose types of images the result has
 * @param {Columns | null} compared  columns of the other view, if two views are compared pixel by pixel
 * @returns {Columns}
 */
export function pixelColumns(coding, view, pixels, serverColumns, compared) {
  const {outcomes, firstClass, ends, leastCrossings} = coding
  const {window, columns, rows} = view
  const codes = new Map(outcomes)
  const count = columns * rows
  const fate = new Uint8Array(count)
  const crossingClass = new Uint8Array(count)
  for (let i = 0; i < count; i++) {
    // Undefined for an escape.
    const outcome = codes.get(pixels.fate[i])
    fate[i] = outcome ?? firstClass + ends[pixels.fate[i] - 1]
    crossingClass[i] = outcome ?? firstClass + leastCrossings.findLastIndex(least => pixels.crossings[i] >= least)
  }
  const [Bytes, Floats] = [serverColumns.fate[0].constructor, serverColumns.escape_time[0].constructor]
  const shape = [rows, columns]
  const emptyImage = new Bytes(new Uint8Array(1).buffer, [1, 1])
  return {
    fate: [new Bytes(fate.buffer, shape)],
    crossing_class: [new Bytes(crossingClass.buffer, shape)],
    crossings: [new Floats(Float32Array.from(pixels.crossings).buffer, shape)],
    escape_time: [new Floats(pixels.time.buffer, shape)],
    ...Object.fromEntries(coding.layers.map(name => [name, [emptyImage]])),
    difference: [compared ? new Bytes(differenceCodes(coding, view, fate, compared).buffer, shape) : emptyImage],
    ends: [coding.words],
    crossing_words: [coding.crossingWords],
    x: [window.xLow],
    y: [window.ordinateLow],
    dw: [window.xHigh - window.xLow],
    dh: [window.ordinateHigh - window.ordinateLow],
    energy: [view.energy],
    complete: [false],
  }
}

/**
 * Return the codes of the differences from the pixels at the same points in another view.
 *
 * @param {Coding} coding
 * @param {import("../engine/pixels.js").View} view
 * @param {Uint8Array} fate  codes of the pixels of the view
 * @param {Columns} compared  columns of the other view
 */
function differenceCodes({undecided, differences}, {window, columns, rows}, fate, compared) {
  const [image, x, y, dw, dh] = ["fate", "x", "y", "dw", "dh"].map(name => compared[name][0])
  const [rowCount, columnCount] = image.shape
  const centres = (/** @type {number} */ low, /** @type {number} */ high, /** @type {number} */ count) =>
    Array.from({length: count}, (_, k) => low + ((high - low) * (k + 0.5)) / count)
  const comparedColumns = centres(window.xLow, window.xHigh, columns).map(centre => Math.floor(((centre - x) / dw) * columnCount))
  const comparedRows = centres(window.ordinateLow, window.ordinateHigh, rows).map(centre =>
    Math.floor(((centre - y) / dh) * rowCount),
  )
  return fate.map((code, pixel) => {
    const [row, column] = [comparedRows[Math.floor(pixel / columns)], comparedColumns[pixel % columns]]
    const isInside = row >= 0 && row < rowCount && column >= 0 && column < columnCount
    return differences[code][isInside ? image[row * columnCount + column] : undecided]
  })
}

/** Largest distance of edges that count as equal, as a share of the side of the window. */
const SAME_EDGE = 1e-6
/** Largest side of a map from the server, as a share of the side of its window. Coarse maps extend beyond their window. */
const WIDEST = 1.1
/** Largest difference of energies that count as equal, as a share of the energy. */
const SAME_ENERGY = 1e-12

/**
 * Whether two energies are equal except for rounding.
 *
 * @param {number} one
 * @param {number} other
 */
export const sameEnergy = (one, other) => Math.abs(one - other) <= SAME_ENERGY * Math.abs(other)

/**
 * Whether an image that begins at `low` covers a side of a window, and is not much wider.
 *
 * @type {(low: number, size: number, from: number, to: number) => boolean}
 */
const coversSide = (low, size, from, to) =>
  Math.abs(low - from) <= SAME_EDGE * (to - from) && size >= (1 - SAME_EDGE) * (to - from) && size <= WIDEST * (to - from)

/**
 * Whether columns from the server show a scene, and their map is complete or has at least as many rows as a preview.
 *
 * @param {Columns} columns
 * @param {import("../workers/frames.js").Scene} scene
 * @param {number} rows  of the preview
 */
export function showsScene({x, y, dw, dh, energy, fate, complete}, {window, energy: sceneEnergy, slice}, rows) {
  const hasEnergy = energyAxis(slice) >= 0 || sameEnergy(energy[0], sceneEnergy)
  const hasWindow =
    coversSide(x[0], dw[0], window.xLow, window.xHigh) && coversSide(y[0], dh[0], window.ordinateLow, window.ordinateHigh)
  return hasEnergy && hasWindow && (complete[0] || fate[0].shape[0] >= rows)
}
