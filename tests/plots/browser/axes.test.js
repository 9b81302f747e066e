// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {tickLabel, ticks} from "../../../plots/browser/modules/figure/axes.js"

test("ticks are multiples of a round number within the range", () => {
  const {values, step} = ticks(-1.02, 1.02, 5)
  assert.equal(step, 0.5)
  assert.deepEqual(values, [-1, -0.5, 0, 0.5, 1])
})

test("there are at most as many ticks as wanted", () => {
  for (const [low, high, most] of [
    [0, 1, 3],
    [0.1, 0.9, 7],
    [-3500, -3000, 4],
    [1e-9, 5e-9, 6],
  ]) {
    const {values, step} = ticks(low, high, most)
    const rounding = 1e-9 * step
    assert.ok(values.length >= 1 && values.length <= most + 1, `${low} ${high} ${values}`)
    assert.ok(values.every(value => value >= low - rounding && value <= high + rounding))
  }
})

test("labels of neighbouring ticks differ, also far from 0", () => {
  const {values, step} = ticks(0.123456, 0.123457, 5)
  const labels = values.map(value => tickLabel(value, step))
  assert.equal(new Set(labels).size, values.length)
  assert.equal(tickLabel(1e-18, 0.5), "0")
})
