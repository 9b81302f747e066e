// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {Potential} from "../../../app/browser/modules/potential.js"
import {mirroredAxes, pixelCentres, Starts, unitOf} from "../../../app/browser/modules/slice.js"
import {windowAt} from "../../../app/browser/modules/system.js"

const potential = new Potential([
  [2, 0, 0.5],
  [0, 2, 0.5],
  [2, 2, -1],
])
/** @type {import("../../../app/browser/modules/system.js").Slice} */
const slice = {axes: ["x", "px"], fixed: {y: 0}, decided: "py", sign: 1}
const system = /** @type {any} */ ({mirror: [0, 2, 1, 4, 3]})
const window = {xLow: -1, xHigh: 1, ordinateLow: -2, ordinateHigh: 2}

test("the energy decides the momentum that is left", () => {
  const starts = new Starts(slice, potential, 0.45)
  assert.ok(starts.find(0, 0.3))
  assert.ok(Math.abs(starts.found.py - 0.9) < 1e-15)
  assert.ok(!starts.find(0.9, 0.5))
})

test("another momentum, with another sign, can be decided", () => {
  const starts = new Starts({axes: ["y", "py"], fixed: {x: 0}, decided: "px", sign: -1}, potential, 0.45)
  assert.ok(starts.find(0, 0.3))
  assert.ok(Math.abs(starts.found.px + 0.9) < 1e-15)
})

test("the energy can be an axis", () => {
  const starts = new Starts({axes: ["x", "h"], fixed: {y: 0, px: 0}, decided: "py", sign: 1}, potential, NaN)
  assert.ok(starts.find(0.6, 0.2))
  assert.ok(Math.abs(starts.found.py - 0.2) < 1e-15)
  assert.ok(starts.requiredEnergy(0.6, 0.1) > 0)
})

test("a symmetric view is mirrored in the axes that change sign", () => {
  assert.deepEqual(mirroredAxes(system, slice, window), [true, true])
  assert.deepEqual(mirroredAxes(system, {...slice, axes: ["x", "y"]}, window), [true, false])
  assert.equal(mirroredAxes(system, slice, {...window, xHigh: 2}), null)
  assert.equal(mirroredAxes(/** @type {any} */ ({mirror: null}), slice, window), null)
  assert.equal(mirroredAxes(system, {...slice, axes: ["y", "py"], decided: "px"}, window), null)
})

test("pixel centres are exactly symmetric", () => {
  const centres = pixelCentres(-1.0056042959335447, 1.0056042959335447, 7)
  assert.deepEqual(
    [...centres],
    [...centres].reverse().map(value => (value === 0 ? 0 : -value)),
  )
})

test("units of the well", () => {
  const units = {length: 4, time: 2}
  assert.deepEqual(
    /** @type {const} */ (["x", "px", "h"]).map(name => unitOf(units, name)),
    [4, 2, 4],
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
