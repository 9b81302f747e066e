// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {pixelColumns, showsScene} from "../../../plots/browser/modules/painting/columns.js"
import {X_PX as slice} from "./x_px.js"

class Image {
  /** @param {ArrayBuffer} buffer @param {[number, number]} shape */
  constructor(buffer, shape) {
    this.buffer = buffer
    this.shape = shape
  }
}

const coding = {
  outcomes: /** @type {[number, number][]} */ ([
    [-3, 0],
    [0, 4],
  ]),
  firstClass: 5,
  ends: [0, 1, 2, 3],
  words: [],
  leastCrossings: [0, 1, 2, 3, 11],
  crossingWords: /** @type {[string, string]} */ (["crossing", "crossings"]),
  undecided: 0,
  differences: Array.from({length: 14}, (_, code) => Array.from({length: 14}, (_, other) => 20 * code + other)),
  layers: ["passage"],
}
const window = {xLow: -1, xHigh: 1, ordinateLow: -2, ordinateHigh: 2}
const scene = {slice, energy: 0.3, window, mostPixels: 224}
const view = {...scene, columns: 3, rows: 1, horizon: 30}
const like = {fate: [new Image(new ArrayBuffer(1), [1, 1])], escape_time: [new Image(new ArrayBuffer(4), [1, 1])]}
const pixels = {fate: Int8Array.of(-3, 1, 4), time: Float32Array.of(NaN, 2, 3), crossings: Uint16Array.of(9, 0, 12)}

test("outcomes, channels and classes of crossings have the codes of the server", () => {
  const columns = pixelColumns(coding, view, pixels, like, null)
  assert.deepEqual([...new Uint8Array(columns.fate[0].buffer)], [0, 5, 8])
  assert.deepEqual([...new Uint8Array(columns.crossing_class[0].buffer)], [0, 5, 9])
  assert.deepEqual(columns.fate[0].shape, [1, 3])
  assert.deepEqual(columns.crossing_words, [["crossing", "crossings"]])
  assert.deepEqual([columns.x, columns.y, columns.dw, columns.dh], [[-1], [-2], [2], [4]])
})

test("a collision has the code of its end and its words", () => {
  const words = ["", "", "", "", "", "", "", "", "collides with a disc"]
  const columns = pixelColumns({...coding, ends: [0, 1, 2, 8], words}, view, pixels, like, null)
  assert.deepEqual([...new Uint8Array(columns.fate[0].buffer)], [0, 5, 13])
  assert.deepEqual(columns.ends, [words])
})

test("pixels are compared with those of the other view at the same place", () => {
  const other = {fate: [Object.assign(Uint8Array.of(5, 6, 7), {shape: [1, 3]})], x: [-1 / 3], y: [-2], dw: [2], dh: [4]}
  const columns = pixelColumns(coding, view, pixels, like, other)
  // The first pixel lies outside the other view, whose pixels are undecided there.
  const {differences, undecided} = coding
  const [one, two, three] = new Uint8Array(columns.fate[0].buffer)
  assert.deepEqual(
    [...new Uint8Array(columns.difference[0].buffer)],
    [differences[one][undecided], differences[two][5], differences[three][6]],
  )
})

const server = (/** @type {Record<string, any>} */ changes) => ({
  x: [-1],
  y: [-2],
  dw: [2],
  dh: [4],
  energy: [0.3],
  complete: [false],
  fate: [{shape: [112, 112]}],
  ...changes,
})

test("a map of the server replaces a preview with as many pixels", () => {
  assert.ok(showsScene(server({}), scene, 112))
  assert.ok(!showsScene(server({}), scene, 224))
  assert.ok(showsScene(server({complete: [true]}), scene, 224))
})

test("a map at another energy or of another window does not", () => {
  assert.ok(!showsScene(server({energy: [0.31]}), scene, 1))
  assert.ok(!showsScene(server({x: [-1.01]}), scene, 1))
  assert.ok(!showsScene(server({dw: [1]}), scene, 1))
})
