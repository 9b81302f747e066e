// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {followFingers} from "../../../app/browser/two_fingers.js"

const range = (/** @type {number} */ start, /** @type {number} */ end, /** @type {number | null} */ least = null) => ({
  start,
  end,
  min_interval: least,
  setv(/** @type {object} */ edges) {
    Object.assign(this, edges)
  },
})
const event = (/** @type {string} */ name, /** @type {number} */ x, /** @type {number} */ y, scale = 1) => ({
  event_name: name,
  x,
  y,
  scale,
})

test("the point between the fingers stays between them at their scale", () => {
  const ranges = [range(0, 4), range(0, 4)]
  /** @type {{point: number, side: number}[]} */
  const held = []
  followFingers(event("pinchstart", 1, 2), ranges, held)
  followFingers(event("pinch", 1, 2, 2), ranges, held)
  assert.deepEqual([ranges[0].start, ranges[0].end, ranges[1].start, ranges[1].end], [0.5, 2.5, 1, 3])
})

test("fingers that move take the point with them", () => {
  const ranges = [range(0, 4), range(0, 4)]
  /** @type {{point: number, side: number}[]} */
  const held = []
  followFingers(event("pinchstart", 1, 1), ranges, held)
  followFingers(event("pinch", 2, 1), ranges, held)
  assert.deepEqual([ranges[0].start, ranges[0].end], [-1, 3])
})

test("zooming ends at the smallest window", () => {
  const ranges = [range(0, 4, 1), range(0, 4, 1)]
  /** @type {{point: number, side: number}[]} */
  const held = []
  followFingers(event("pinchstart", 2, 2), ranges, held)
  followFingers(event("pinch", 2, 2, 1000), ranges, held)
  assert.equal(ranges[0].end - ranges[0].start, 1)
})
