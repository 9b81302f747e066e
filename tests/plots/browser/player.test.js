// @ts-check
import assert from "node:assert/strict"
import {mock, test} from "node:test"

import {EnergyPlayer} from "../../../plots/browser/modules/gestures/player.js"

/** @type {((now: number) => void) | null} */
let callback = null
globalThis.requestAnimationFrame = given => {
  callback = given
  return 1
}
globalThis.cancelAnimationFrame = () => {
  callback = null
}

/** @param {number} energy */
function startPlayer(energy) {
  const [show, end] = [mock.fn(), mock.fn()]
  const player = new EnergyPlayer(show, end)
  player.start(energy, 0, 1)
  const tick = (/** @type {number} */ ms) => callback?.(performance.now() + ms)
  const shown = () => show.mock.calls.map(call => call.arguments[0])
  return {player, tick, shown, end}
}

test("the whole range takes 20 s", () => {
  const {tick, shown} = startPlayer(0)
  tick(10_000)
  assert.ok(Math.abs(shown()[0] - 0.5) < 0.01)
})

test("it stops at the end of the range", () => {
  const {player, tick, shown, end} = startPlayer(0.5)
  tick(30_000)
  assert.deepEqual([shown(), player.playing, end.mock.calls[0].arguments], [[1], false, [1]])
})

test("stopped, it reports the energy it has reached, once", () => {
  const {player, tick, end} = startPlayer(0)
  tick(10_000)
  player.stop()
  player.stop()
  assert.equal(end.mock.callCount(), 1)
  assert.equal(callback, null)
})
