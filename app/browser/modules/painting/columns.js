// @ts-check
/**
 * The pixel codes of outcomes and classes, which the server sends (`app/browser/views.py`).
 *
 * @typedef {object} Coding
 * @property {[number, number][]} outcomes  fate and code of the outcomes that are not escapes
 * @property {number} first  code of the first class
 * @property {number[]} ends  place of each outcome, from fate 1, among all ends
 * @property {string[]} words  descriptions of all ends
 * @property {number[]} leastCrossings  fewest crossings of each class
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
 * @param {Columns} like  columns from the server, with the types of the images
 * @param {Columns | null} compared  columns of the other view, if two views are compared pixel by pixel
 * @returns {Columns}
 */
export function pixelColumns(coding, view, pixels, like, compared) {
  const {outcomes, first, ends, leastCrossings} = coding
  const {window, columns, rows} = view
  const codes = new Map(outcomes)
  const count = columns * rows
  const fate = new Uint8Array(count)
  const crossingClass = new Uint8Array(count)
  for (let i = 0; i < count; i++) {
    const outcome = codes.get(pixels.fate[i])
    fate[i] = outcome ?? first + ends[pixels.fate[i] - 1]
    crossingClass[i] = outcome ?? first + leastCrossings.findLastIndex(least => pixels.crossings[i] >= least)
  }
  const [Bytes, Floats] = [like.fate[0].constructor, like.escape_time[0].constructor]
  const shape = [rows, columns]
  const none = new Bytes(new Uint8Array(1).buffer, [1, 1])
  return {
    fate: [new Bytes(fate.buffer, shape)],
    crossing_class: [new Bytes(crossingClass.buffer, shape)],
    crossings: [new Floats(Float32Array.from(pixels.crossings).buffer, shape)],
    escape_time: [new Floats(pixels.time.buffer, shape)],
    ...Object.fromEntries(coding.layers.map(name => [name, [none]])),
    difference: [compared ? new Bytes(differencesFrom(coding, view, fate, compared).buffer, shape) : none],
    ends: [coding.words],
    x: [window.xLow],
    y: [window.ordinateLow],
    dw: [window.xHigh - window.xLow],
    dh: [window.ordinateHigh - window.ordinateLow],
    energy: [view.energy],
    complete: [false],
  }
}

/**
 * Return the codes of the differences from the pixels at the same places in another view.
 *
 * @param {Coding} coding
 * @param {import("../engine/pixels.js").View} view
 * @param {Uint8Array} fate  codes of the pixels of the view
 * @param {Columns} compared
 */
function differencesFrom({undecided, differences}, {window, columns, rows}, fate, compared) {
  const [image, x, y, dw, dh] = ["fate", "x", "y", "dw", "dh"].map(name => compared[name][0])
  const [rowsThere, columnsThere] = image.shape
  const places = (/** @type {number} */ low, /** @type {number} */ high, /** @type {number} */ count) =>
    Array.from({length: count}, (_, k) => low + ((high - low) * (k + 0.5)) / count)
  const across = places(window.xLow, window.xHigh, columns).map(place => Math.floor(((place - x) / dw) * columnsThere))
  const up = places(window.ordinateLow, window.ordinateHigh, rows).map(place => Math.floor(((place - y) / dh) * rowsThere))
  return fate.map((code, pixel) => {
    const [row, column] = [up[Math.floor(pixel / columns)], across[pixel % columns]]
    const isInside = row >= 0 && row < rowsThere && column >= 0 && column < columnsThere
    return differences[code][isInside ? image[row * columnsThere + column] : undecided]
  })
}

/** Largest distance of equal edges of windows, as a share of a side. */
const SAME_EDGE = 1e-6
/** Largest size of a coarse frame from the server, which extends beyond its window, as a share of the size of the window. */
const WIDEST = 1.1
/** Largest difference of equal energies, as a share of the energy. */
const SAME_ENERGY = 1e-12

/**
 * Whether two energies are equal but for rounding.
 *
 * @param {number} one
 * @param {number} other
 */
export const sameEnergy = (one, other) => Math.abs(one - other) <= SAME_ENERGY * Math.abs(other)

/**
 * Whether columns from the server show a scene, complete or with at least as many rows as a preview.
 *
 * @param {Columns} columns
 * @param {import("../workers/frames.js").Scene} scene
 * @param {number} rows  of the preview
 */
export function showsScene({x, y, dw, dh, energy, fate, complete}, {window, energy: wanted, slice}, rows) {
  const near = (/** @type {number} */ low, /** @type {number} */ size, /** @type {number} */ from, /** @type {number} */ to) =>
    Math.abs(low - from) <= SAME_EDGE * (to - from) && size >= (1 - SAME_EDGE) * (to - from) && size <= WIDEST * (to - from)
  const ofEnergy = energyAxis(slice) >= 0 || sameEnergy(energy[0], wanted)
  const sameWindow = near(x[0], dw[0], window.xLow, window.xHigh) && near(y[0], dh[0], window.ordinateLow, window.ordinateHigh)
  return ofEnergy && sameWindow && (complete[0] || fate[0].shape[0] >= rows)
}
