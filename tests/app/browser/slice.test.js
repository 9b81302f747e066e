// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {mirroredAxes, pixelCentres, space, Starts} from "../../../app/browser/modules/slice.js"
import {windowAt} from "../../../app/browser/modules/system.js"
import {X_PX as slice} from "./x_px.js"

const potential = {value: (/** @type {number} */ x, /** @type {number} */ y) => 0.5 * (x * x + y * y) - x * x * y * y}
/** @typedef {import("../../../app/browser/modules/system.js").Slice} Slice */
const system = /** @type {any} */ ({mirror: [0, 2, 1, 4, 3]})
const window = {xLow: -1, xHigh: 1, ordinateLow: -2, ordinateHigh: 2}

test("another momentum, with another sign, can be decided", () => {
  const starts = new Starts({...slice, moves: [{y: 1}, {py: 1}], fixed: {x: 0}, decided: "px", sign: -1}, potential, 0.45)
  assert.ok(starts.find(0, 0.3))
  assert.ok(Math.abs(starts.found.px + 0.9) < 1e-15)
})

test("the energy can be an axis", () => {
  const starts = new Starts({...slice, axes: ["x", "h"], moves: [{x: 1}, {h: 1}]}, potential, NaN)
  assert.ok(starts.find(0.6, 0.2))
  assert.ok(Math.abs(starts.found.py - 0.2) < 1e-15)
  assert.ok(starts.requiredEnergy(0.6, 0.1) > 0)
})

test("an angle can be that from the radius, at the origin that from the +x axis", () => {
  const tangential = /** @type {Slice} */ ({...space({length: 1, time: 1}), fixed: {beta: Math.PI / 2}, decided: "v"})
  const starts = new Starts(tangential, potential, 0.45)
  for (const [x, y] of [
    [0.3, -0.4],
    [0, 0],
  ]) {
    assert.ok(starts.find(x, y))
    const {px, py, h} = starts.found
    assert.ok(Math.abs(x * px + y * py) < 1e-15)
    assert.ok(Math.abs(0.5 * (px * px + py * py) + potential.value(x, y) - h) < 1e-15)
  }
})

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
