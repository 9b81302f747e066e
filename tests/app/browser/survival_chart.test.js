// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {drawSurvival} from "../../../app/browser/modules/painting/survival_chart.js"

/** The points of each line that is drawn for orbits of which half have left at t = 1, and the others stay. */
function drawnLines({rate = 0, unit = 1} = {}) {
  /** @type {[number, number][][]} */
  const lines = []
  const context = new Proxy(
    {
      beginPath: () => lines.push([]),
      lineTo: (/** @type {number} */ x, /** @type {number} */ y) => lines[lines.length - 1].push([x, y]),
    },
    {get: (target, /** @type {"lineTo"} */ name) => target[name] ?? (() => {}), set: () => true},
  )
  Object.assign(globalThis, {window: {devicePixelRatio: 1}})
  const canvas = {clientWidth: 300, clientHeight: 200, getContext: () => context}
  const ensemble = {escapeTime: Float64Array.of(1, Infinity), count: 2, time: 8}
  drawSurvival(/** @type {any} */ (canvas), ensemble, {longest: 10, unit, rate, ink: "black"})
  return lines
}

test("orbits that stay keep the share up until the time reached", () => {
  const [line] = drawnLines()
  const heights = line.map(([, y]) => y)
  assert.equal(new Set(heights).size, 2)
  assert.equal(heights[0], Math.min(...heights))
  // Half the height of a decade is log 2 of it.
  const [line2] = drawnLines({rate: Math.LN10 / 10})
  const decade = line2[line2.length - 1][1] - line2[0][1]
  assert.ok(Math.abs((Math.max(...heights) - heights[0]) / decade - Math.log10(2)) < 1e-9)
})

test("the law of mixed motion has the rate in units of the page", () => {
  assert.deepEqual(drawnLines({rate: 0.05, unit: 4})[0], drawnLines({rate: 0.2})[0])
})
