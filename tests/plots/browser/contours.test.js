// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {levelLines, SAMPLES} from "../../../plots/browser/modules/engine/contours.js"

const window = {xLow: -2, xHigh: 2, ordinateLow: -2, ordinateHigh: 2}

/** @param {(x: number, y: number) => number} sample */
function sampleGrid(sample) {
  const places = Array.from({length: SAMPLES}, (_, k) => -2 + (4 * k) / (SAMPLES - 1))
  return {window, values: Float64Array.from(places.flatMap(y => places.map(x => sample(x, y))))}
}

test("a circle is one closed line of points on it", () => {
  const lines = levelLines(
    sampleGrid((x, y) => x * x + y * y),
    1,
  )
  assert.equal(lines.length, 1)
  const [{xs, ys}] = lines
  assert.deepEqual([xs[0], ys[0]], [xs.at(-1), ys.at(-1)])
  for (const [i, x] of xs.entries()) assert.ok(Math.abs(Math.hypot(x, ys[i]) - 1) < 1e-3)
})

test("a hyperbola has two lines that end at the edges", () => {
  const lines = levelLines(
    sampleGrid((x, y) => x * y),
    0.5,
  )
  assert.equal(lines.length, 2)
  for (const {xs, ys} of lines) {
    const ends = [0, xs.length - 1].map(i => Math.max(Math.abs(xs[i]), Math.abs(ys[i])))
    assert.deepEqual(ends, [2, 2])
  }
})

test("a level that is not reached has no lines", () => {
  const grid = sampleGrid(() => 1)
  assert.deepEqual(levelLines(grid, 0), [])
})
