// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {mapColours} from "../../../plots/browser/modules/painting/pixel_image.js"

// As the bytes of a canvas: red, green, blue, opacity.
const [RED, GREEN, BLUE] = [
  [255, 0, 0, 255],
  [0, 255, 0, 128],
  [0, 0, 255, 255],
]
const palette = ["#ff0000", 0x00ff0080, "#0000ffff"]

/** @param {number[]} image @param {{type: string, low: number, high: number}} mapper @param {number} columns */
function paint(image, mapper, columns) {
  const colours = new Uint32Array(image.length)
  mapColours(image, {...mapper, palette}, colours, columns)
  const bytes = new Uint8Array(colours.buffer)
  return image.map((_, k) => [...bytes.subarray(4 * k, 4 * k + 4)])
}

test("the first row of an image is the lowest one on a canvas", () => {
  const linear = {type: "LinearColorMapper", low: 0, high: 3}
  assert.deepEqual(paint([0, 1, 2, 0, 0, 1], linear, 2), [RED, GREEN, BLUE, RED, RED, GREEN])
})

test("a logarithmic scale has equal ratios, numbers beyond its ends have their colours, and NaN has none", () => {
  const logarithmic = {type: "LogColorMapper", low: 1, high: 1000}
  assert.deepEqual(paint([5, 50, 500, 0.1, 1e4, NaN], logarithmic, 6), [RED, GREEN, BLUE, RED, BLUE, [0, 0, 0, 0]])
})
