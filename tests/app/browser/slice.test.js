// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {mirroredAxes, pixelCentres, space} from "../../../app/browser/modules/slice.js"
import {windowAt} from "../../../app/browser/modules/system.js"
import {X_PX as slice} from "./x_px.js"

const system = /** @type {any} */ ({mirror: [0, 2, 1, 4, 3]})
const window = {xLow: -1, xHigh: 1, ordinateLow: -2, ordinateHigh: 2}

test("a symmetric view is mirrored in the axes that change sign", () => {
  assert.deepEqual(mirroredAxes(system, slice, window), [true, true])
  assert.deepEqual(mirroredAxes(system, space({length: 1, time: 1}), window), [true, false])
  assert.equal(mirroredAxes(system, slice, {...window, xHigh: 2}), null)
  assert.equal(mirroredAxes(/** @type {any} */ ({mirror: null}), slice, window), null)
  assert.equal(mirroredAxes(system, {mirrored: null}, window), null)
})

test("pixel centres are exactly symmetric", () => {
  const centres = pixelCentres(-1.0056042959335447, 1.0056042959335447, 7)
  assert.deepEqual(
    [...centres],
    [...centres].reverse().map(value => (value === 0 ? 0 : -value)),
  )
})

test("default windows are linear between energies, and end with the table", () => {
  /** @type {import("../../../app/browser/modules/system.js").WindowTable} */
  const table = {
    energies: [1, 2],
    windows: [
      [-1, 1, -2, 2],
      [-3, 3, -4, 4],
    ],
  }
  assert.deepEqual(windowAt(table, 1.5), {xLow: -2, xHigh: 2, ordinateLow: -3, ordinateHigh: 3})
  assert.deepEqual(windowAt(table, 1)?.xLow, -1)
  assert.equal(windowAt(table, 2.1), null)
  assert.equal(windowAt(undefined, 1), null)
})
