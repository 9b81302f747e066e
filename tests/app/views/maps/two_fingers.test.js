// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {followFingers} from "../../../../app/views/maps/two_fingers.js"

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

test("zooming ends at the smallest window", () => {
  const ranges = [range(0, 4, 1), range(0, 4, 1)]
  /** @type {{point: number, side: number}[]} */
  const held = []
  followFingers(event("pinchstart", 2, 2), ranges, held)
  followFingers(event("pinch", 2, 2, 1000), ranges, held)
  assert.equal(ranges[0].end - ranges[0].start, 1)
})
