// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {placesOf, Shares} from "../../../plots/browser/modules/workers/shares.js"
import {X_PX as slice} from "./x_px.js"

const window = {xLow: -1, xHigh: 1, ordinateLow: -1, ordinateHigh: 1}

/** Shares at energies from 0 to 1, of which those above a limit cannot be computed. @param {number} limit */
function makeShares(limit) {
  /** @type {number[]} */
  const shown = []
  const sceneAt = (/** @type {number} */ energy) => (energy > limit ? null : {slice, energy, window, mostPixels: 224})
  return {shares: new Shares(sceneAt, 50, place => shown.push(place)), shown}
}

/** Compute all maps, whose pixels have these fates. @param {Shares} shares @param {number[]} fate */
function computeAll(shares, fate) {
  const pixels = {fate: Int8Array.from(fate), time: new Float32Array(0), crossings: new Uint16Array(0)}
  for (let map = shares.next(); map; map = shares.next()) map.receive(pixels)
}

test("energies are the ends, the middle, the quarters, and so on", () => {
  assert.deepEqual(placesOf(0), [0, 1])
  assert.deepEqual(placesOf(2), [0, 1, 0.5, 0.25, 0.75])
})

test("pixels are counted by their fates, at all energies that have a map", () => {
  const {shares, shown} = makeShares(0.5)
  shares.refine(2)
  computeAll(shares, [1, 2, 2, -1])
  assert.deepEqual(shown, [0, 0.5, 0.25])
  const counts = shares.counts.get(0.25) ?? assert.fail("no counts")
  assert.deepEqual(Object.fromEntries(counts), {1: 1, 2: 2, [-1]: 1})
})

test("a map that was not finished is computed again, and a finer division computes only the new energies", () => {
  const {shares, shown} = makeShares(1)
  shares.refine(1)
  assert.equal(shares.next()?.view.energy, 0)
  assert.equal(shares.next()?.view.energy, 0)
  assert.equal(shares.next()?.view.horizon, 50)
  computeAll(shares, [1])
  shares.refine(2)
  computeAll(shares, [1])
  assert.deepEqual(shown, [0, 1, 0.5, 0.25, 0.75])
})
