// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {placeBox} from "../../../app/browser/modules/gestures/tour.js"

const AREA = {left: 0, top: 50, right: 1000, bottom: 800}
const SIZE = {width: 200, height: 150}

/** @type {(left: number, top: number, right: number, bottom: number) => import("../../../app/browser/modules/gestures/tour.js").Box} */
const box = (left, top, right, bottom) => ({left, top, right, bottom})

test("the box is to the right of a part, or to its left, or below it, or above it", () => {
  assert.deepEqual(placeBox([box(300, 100, 700, 500)], SIZE, AREA, false), [708, 100])
  assert.deepEqual(placeBox([box(300, 100, 990, 500)], SIZE, AREA, false), [92, 100])
  assert.deepEqual(placeBox([box(10, 100, 990, 500)], SIZE, AREA, false), [10, 508])
  assert.deepEqual(placeBox([box(10, 400, 990, 790)], SIZE, AREA, false), [10, 242])
})

test("the box covers neither what is above the area nor another part", () => {
  assert.deepEqual(placeBox([box(300, 0, 700, 40)], SIZE, AREA, false), [708, 58])
  assert.deepEqual(placeBox([box(300, 100, 500, 300), box(800, 100, 990, 300)], SIZE, AREA, false), [92, 100])
})

test("of parts without space around them the box covers as little as possible", () => {
  assert.deepEqual(placeBox([box(100, 60, 990, 790)], SIZE, AREA, false), [8, 60])
})

test("in a narrow window the box is at the foot, or at the head if it would cover the part", () => {
  assert.deepEqual(placeBox([box(0, 50, 1000, 400)], SIZE, AREA, true), [400, 642])
  assert.deepEqual(placeBox([box(0, 500, 1000, 790)], SIZE, AREA, true), [400, 58])
})
