// @ts-check
import assert from "node:assert/strict"
import {mock, test} from "node:test"

import {Frames, LEAST_SIDE, mirroredAxes, PixelCollector} from "../../../plots/browser/modules/workers/frames.js"
import {X_PX as slice} from "./x_px.js"

const window = {xLow: -1, xHigh: 1, ordinateLow: -1, ordinateHigh: 1}
const system = /** @type {any} */ ({mirror: [0, 2, 1]})
const scene = (/** @type {number} */ energy) => ({slice, energy, window, mostPixels: 224})
const view = {...scene(0.3), columns: 3, rows: 3, horizon: 30}

test("half of a symmetric picture is computed, the other half has the mirror images of the channels", () => {
  const picture = new PixelCollector(system, view)
  const parts = picture.divide(2)
  assert.deepEqual(
    parts.map(({rows}) => [...rows]),
    [[0], [1]],
  )
  const computed = (/** @type {number[]} */ fate) => ({
    fate: Int8Array.from(fate),
    time: Float32Array.of(1, 2, 3),
    crossings: Uint16Array.of(4, 5, 6),
  })
  picture.add(parts[0], computed([1, 2, -1]))
  picture.add(parts[1], computed([1, -3, 2]))
  const {fate, time} = picture.finish()
  assert.deepEqual([...fate], [1, 2, -1, 1, -3, 2, -1, 1, 2])
  assert.deepEqual([...time.subarray(6)], [3, 2, 1])
})

/**
 * Frames with a pool that answers when it is told to. All pixels have the fate 0.
 *
 * @param {{longest?: number, undecided?: number}} options  longest time at rest, and the fate of undecided pixels
 */
function startFrames({longest, undecided} = {}) {
  /** @type {{view: any, finish: () => void}[]} */
  const asked = []
  const pool = /** @type {any} */ ({
    setSystem: () => {},
    cancel: mock.fn(),
    compute: (/** @type {any} */ given, /** @type {any[]} */ parts, /** @type {Function} */ receive) => {
      const none = {fate: new Int8Array(0), time: new Float32Array(0), crossings: new Uint16Array(0)}
      asked.push({view: given, finish: () => parts.forEach(part => receive({...part, rows: new Uint32Array(0)}, none))})
    },
  })
  /** @type {any[]} */
  const shown = []
  const frames = new Frames(pool, 1, given => shown.push(given), longest)
  frames.setSystem({...system, layout: {fates: {notComputed: undecided}}}, /** @type {any} */ (null))
  return {frames, asked, shown, pool}
}

test("while a picture is computed only the newest scene waits", () => {
  mock.timers.enable({apis: ["setTimeout"]})
  const {frames, asked, shown} = startFrames()
  for (const energy of [0.3, 0.31, 0.32]) frames.request(scene(energy))
  assert.deepEqual(
    asked.map(({view: {energy}}) => energy),
    [0.3],
  )
  asked[0].finish()
  assert.deepEqual(
    asked.map(({view: {energy}}) => energy),
    [0.3, 0.32],
  )
  assert.equal(shown.length, 1)
  frames.stop()
  mock.timers.reset()
})

test("at rest the picture gets finer and longer, and a new scene replaces that at once", () => {
  mock.timers.enable({apis: ["setTimeout"]})
  const {frames, asked} = startFrames()
  frames.request(scene(0.3))
  assert.equal(asked[0].view.columns, LEAST_SIDE)
  asked[0].finish()
  mock.timers.tick(100)
  assert.deepEqual([asked[1].view.columns, asked[1].view.horizon], [112, 100])
  frames.request(scene(0.4))
  assert.equal(asked[2].view.energy, 0.4)
  frames.stop()
  mock.timers.reset()
})

for (const [undecided, horizons] of /** @type {[number, number[]][]} */ ([
  [0, [30, 100, 100, 200, 250]],
  [-3, [30, 100, 100]],
])) {
  test(`at rest the time doubles up to the longest time if pixels with fate 0 are undecided: ${undecided === 0}`, () => {
    mock.timers.enable({apis: ["setTimeout"]})
    const {frames, asked} = startFrames({longest: 250, undecided})
    frames.request(scene(0.3))
    for (let k = 0; k < asked.length; k++) {
      asked[k].finish()
      mock.timers.tick(100)
    }
    assert.deepEqual(
      asked.map(({view: {horizon}}) => horizon),
      horizons,
    )
    mock.timers.reset()
  })
}

test("other views are computed only at rest, and a scene replaces the one under way, which is computed again", () => {
  mock.timers.enable({apis: ["setTimeout"]})
  const {frames, asked, shown} = startFrames({undecided: -3})
  const extras = [0.8, 0.9].map(energy => ({...view, energy}))
  frames.setExtras(() => (extras.length > 0 ? {view: extras[0], receive: () => void extras.shift()} : null))
  frames.request(scene(0.3))
  mock.timers.tick(100)
  for (let k = 0; k < 3; k++) {
    asked[k].finish()
    mock.timers.tick(100)
  }
  frames.request(scene(0.4))
  for (let k = 4; k < asked.length; k++) {
    asked[k].finish()
    mock.timers.tick(100)
  }
  const energies = asked.map(({view: {energy}}) => energy)
  assert.deepEqual(
    energies.filter((energy, k) => energy !== energies[k - 1]),
    [0.3, 0.8, 0.4, 0.8, 0.9],
  )
  assert.deepEqual(new Set(shown.map(({energy}) => energy)), new Set([0.3, 0.4]))
  mock.timers.reset()
})

test("a preview has no more pixels than the map", () => {
  mock.timers.enable({apis: ["setTimeout"]})
  const {frames, asked} = startFrames()
  frames.request({...scene(0.3), mostPixels: 112})
  for (let k = 0; k < 3; k++) {
    asked[k]?.finish()
    mock.timers.tick(100)
  }
  assert.ok(asked.every(({view: {columns}}) => columns <= 112))
  frames.stop()
  mock.timers.reset()
})

test("a symmetric view is mirrored in the axes that change sign", () => {
  assert.deepEqual(mirroredAxes(system, slice, window), [true, true])
  assert.deepEqual(mirroredAxes(system, {mirrored: [true, false]}, {...window, ordinateHigh: 2}), [true, false])
  assert.equal(mirroredAxes(system, slice, {...window, xHigh: 2}), null)
  assert.equal(mirroredAxes(/** @type {any} */ ({mirror: null}), slice, window), null)
  assert.equal(mirroredAxes(system, {mirrored: null}, window), null)
})
