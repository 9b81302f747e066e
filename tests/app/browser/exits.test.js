// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {exitLines} from "../../../app/browser/modules/curves.js"
import {drawEntrances} from "../../../app/browser/modules/exit_starts.js"
import {crossedExit, exitCurves, findExitTime, passedExit} from "../../../app/browser/modules/exits.js"
import {randomNumbers} from "../../../app/browser/modules/ensemble_starts.js"

/** The line x = 0.5 with |y| ≤ 1. */
const row = [0.4, 1, 0.5, 0, 1, 0, 0, 1, 0, 0, 0]
const table = {saddle: 0, highest: 1, nodes: [1], rows: [row]}
const line = /** @type {const} */ ({shape: "line", ...table})
const curve = /** @type {const} */ ({shape: "curve", ...table})
const disc = /** @type {const} */ ({side: -1, x: 1, y: 0, radius: 0.5})
const circle = /** @type {const} */ ({side: 1, x: 0, y: 0, radius: 0.5})

/** Series of one lane. @type {(...coefficients: number[]) => import("../../../app/browser/modules/series.js").Jet} */
const jet = (...coefficients) => ({
  jet: Float64Array.from(coefficients),
  first: 0,
  stride: 1,
  order: coefficients.length - 1,
})

for (const [name, exit] of Object.entries({line, disc, circle})) {
  test(`an orbit that passes a ${name} and returns within a step has passed it where it crosses outward`, () => {
    // x = 2.2 t (1 − t) is 0.55 at t = ½ and 0.5 at (1 − √(1/11)) / 2.
    const [exits, x, y] = [exitCurves([exit], 1), jet(0, 2.2, -2.2), jet(0, 0, 0)]
    assert.equal(crossedExit(exits, 0, 0, 0, 0), 0)
    assert.equal(passedExit(exits, x, y, 0, 1), 1)
    assert.ok(Math.abs(findExitTime(exits[0], x, y, 0, 1) - 0.5 * (1 - Math.sqrt(1 / 11))) < 1e-8)
    assert.equal(passedExit(exits, jet(0, 1.8, -1.8), y, 0, 1), 0)
    assert.equal(passedExit(exits, x, jet(2, 0, 0), 0, 1), exit === circle ? 1 : 0)
  })
}

test("orbits do not return over a Lyapunov orbit", () => {
  assert.equal(passedExit(exitCurves([curve], 1), jet(0, 2.2, -2.2), jet(0, 0, 0), 0, 1), 0)
})

test("circles are drawn closed, as far from their centre as they are, without a number", () => {
  const system = /** @type {any} */ ({exits: [disc, circle], units: {length: 2, time: 2}})
  const lines = exitLines(system, 1)
  assert.deepEqual(
    lines.map(({channel}) => channel),
    [1, 2],
  )
  for (const [k, middle] of [2, 0].entries()) {
    const {xs, ys, label} = lines[k]
    for (const [i, x] of xs.entries()) assert.ok(Math.abs(Math.hypot(x - middle, ys[i]) - 1) < 1e-12)
    assert.ok(Math.hypot(xs[0] - xs[xs.length - 1], ys[0] - ys[ys.length - 1]) < 1e-12)
    assert.ok(label.every(Number.isNaN))
  }
})

test("orbits enter over saddles only", () => {
  const [potential, random] = [/** @type {any} */ ({value: () => 0}), randomNumbers(1)]
  const states = drawEntrances(50, exitCurves([line, disc, circle], 1), potential, 1, random)
  for (let k = 0; k < 50; k++) {
    const [x, y, px] = states.subarray(4 * k)
    assert.ok(Math.abs(x - 0.5) < 1e-6 && Math.abs(y) < 1 && px < 0)
  }
  assert.equal(drawEntrances(5, exitCurves([disc, circle], 1), potential, 1, random).length, 0)
})
