// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {describeOutcome, toPageUnits} from "../../../plots/browser/modules/painting/orbit_drawing.js"

test("the path of an orbit is in units of the page", () => {
  assert.deepEqual(toPageUnits({x: [0.5, 1], y: [-1, 0.25]}, {length: 4}), {xs: [2, 4], ys: [-4, 1]})
})

test("the end of an orbit is named as its outcome", () => {
  const labels = ["exit 1", "collision with the Moon", "escape"]
  const say = (/** @type {number} */ channel, /** @type {number} */ crossings) =>
    describeOutcome({channel, time: 6.17283, crossings}, 2, labels)
  assert.equal(say(1, 1), "Exit 1 at t = 12.35, 1 crossing")
  assert.equal(say(2, 3), "Collision with the Moon at t = 12.35, 3 crossings")
  assert.equal(say(3, 0), "Escape at t = 12.35, 0 crossings")
  assert.equal(say(0, 2), "Inside until t = 12.35, 2 crossings")
})
