// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {paintShares} from "../../../app/browser/modules/painting/share_columns.js"

/** The rectangles that are painted for columns, on a canvas of 80 × 12 pixels. @param {any} columns */
function painted(columns) {
  /** @type {[colour: string, x: number, y: number, width: number, height: number][]} */
  const rectangles = []
  const canvas = {clientWidth: 80, clientHeight: 12, width: 0, height: 0, getContext: () => context}
  const context = {
    canvas,
    fillStyle: "",
    setTransform: () => {},
    clearRect: () => rectangles.splice(0),
    /** @type {(x: number, y: number, width: number, height: number) => void} */
    fillRect(x, y, width, height) {
      rectangles.push([this.fillStyle, x, y, width, height])
    },
  }
  Object.assign(globalThis, {window: {devicePixelRatio: 1}})
  paintShares(/** @type {any} */ (canvas), columns)
  return rectangles
}

const HALF = [
  ["red", 1],
  ["grey", 1],
]
const FULL = [["red", 5]]

test("columns reach halfway to the next known values, and are as high as the shares", () => {
  const columns = [0, 1, 0.5, 0.25, 0.75].map(place => [place, place === 1 ? HALF : FULL])
  assert.deepEqual(painted(columns), [
    ["red", 0, 0, 10, 12],
    ["red", 10, 0, 20, 12],
    ["red", 30, 0, 20, 12],
    ["red", 50, 0, 20, 12],
    ["red", 70, 0, 10, 6],
    ["grey", 70, 6, 10, 6],
  ])
})

test("a value without pixels leaves its column empty", () => {
  const columns = [0, 0.25, 0.5, 0.75, 1].map(place => [place, place === 0.5 ? [] : FULL])
  assert.deepEqual(
    painted(columns).map(([, x]) => x),
    [0, 10, 50, 70],
  )
})

test("nothing is painted for a few values", () => {
  assert.deepEqual(painted([0, 1, 0.5, 0.25].map(place => [place, FULL])), [])
})
