// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {Dots} from "../../../app/browser/modules/painting/dots.js"

const WINDOW = {xLow: 0, xHigh: 2, ordinateLow: -1, ordinateHigh: 1}
const COLOURING = {
  orbits: ["red", "blue"],
  inside: "grey",
  ends: ["green", "orange"],
  densities: [1, 2, 4],
  classes: ["low", "middle", "high"],
  cells: 10,
}

/** The dots of a chart of 200 x 100 pixels, and the colour of each painted place. @param {string} choice */
function makeDots(choice) {
  /** @type {Record<string, string>} */
  const painted = {}
  const context = {
    fillStyle: "",
    fillRect(/** @type {number} */ left, /** @type {number} */ top) {
      painted[`${left + 1} ${top + 1}`] = this.fillStyle
    },
  }
  return {dots: new Dots(/** @type {any} */ (context), {width: 200, height: 100}, WINDOW, {choice, ...COLOURING}), painted}
}

test("points of an orbit have one of the colours of orbits", () => {
  const {dots, painted} = makeDots("orbit")
  dots.add(0, [1, 0], [])
  dots.add(3, [2, 1], [])
  dots.end(3, 1)
  assert.deepEqual(painted, {"100 50": "red", "200 0": "blue"})
})

test("points of an orbit get the colour of its outcome when it ends", () => {
  const {dots, painted} = makeDots("fate")
  dots.add(0, [1, 0], [])
  dots.add(1, [2, 1], [])
  dots.add(1, [0, 1], [])
  dots.end(1, 2)
  dots.end(2, 1)
  assert.deepEqual(painted, {"100 50": "grey", "200 0": "orange", "0 0": "orange"})
})

test("points get the colour of the number of points in their cell", () => {
  const {dots, painted} = makeDots("density")
  dots.add(0, [1.01, 0.02], [])
  dots.add(0, [1.5, 0.5], [])
  dots.add(1, [1.02, 0.02], [])
  assert.deepEqual(Object.values(painted).sort(), ["low", "middle", "middle"])
  dots.add(2, [1.03, 0.02], [])
  assert.deepEqual(Object.values(painted).sort(), ["low", "middle", "middle", "middle"])
  dots.add(2, [1.04, 0.02], [])
  assert.deepEqual(Object.values(painted).sort(), ["high", "high", "high", "high", "low"])
})

test("the nearest point is found by its place on the canvas", () => {
  const {dots} = makeDots("density")
  assert.equal(dots.nearest(0, 0), null)
  dots.add(0, [1, 0], [1])
  dots.add(0, [1.5, 0.5], [2])
  assert.deepEqual(dots.nearest(140, 30), [2])
  assert.deepEqual(dots.nearest(110, 40), [1])
})
