// @ts-check
import assert from "node:assert/strict"
import {afterEach, beforeEach, mock, test} from "node:test"

import {storeOf} from "../../../../app/browser/modules/view_store.js"
import {connectStore} from "../../../../app/views/components/view_store.js"

/** @typedef {import("../../../../plots/browser/modules/engine/starts.js").Window} Window */

const HOME = makeWindow(-1, 1)
const CLOSER = makeWindow(-0.5, 0.5)

/** @param {number} xLow @param {number} xHigh */
function makeWindow(xLow, xHigh) {
  return {xLow, xHigh, ordinateLow: -1, ordinateHigh: 1}
}

/** A model of Bokeh, whose properties report their changes. */
class Model {
  /** @type {Record<string, any>} */
  properties = {}
  /** @type {Map<string, () => void>} */
  events = new Map()

  /** @param {Record<string, any>} values */
  constructor(values) {
    Object.assign(this, values)
    for (const name of Object.keys(values)) this.properties[name] = {change: new Set()}
  }

  /** @param {Set<() => void>} signal @param {() => void} slot */
  connect(signal, slot) {
    signal.add(slot)
  }

  /** @param {Record<string, any>} values @param {{sync: boolean}} [_options] */
  setv(values, _options) {
    for (const [name, value] of Object.entries(values)) {
      const self = /** @type {any} */ (this)
      if (self[name] === value) continue
      self[name] = value
      for (const slot of this.properties[name].change) slot()
    }
  }

  /** @param {string} event @param {() => void} slot */
  on_event(event, slot) {
    this.events.set(event, slot)
  }
}

/** A page that shows the whole interior. */
function makePage() {
  const shown = (/** @type {any} */ value) => ({value, count: 0})
  const data = new Model({energy: shown(0.19), window: shown(HOME)})
  const [x, y] = [new Model({start: -9, end: 9}), new Model({start: -9, end: 9})]
  const models = {BrowserEngine: {data}, basins: Object.assign(new Model({}), {x_range: x, y_range: y})}
  const bokehDocument = {get_model_by_name: (/** @type {"BrowserEngine" | "basins"} */ name) => models[name]}
  const sent = /** @type {any[]} */ ([])
  const model = {document: bokehDocument, send_msg: (/** @type {any} */ message) => sent.push(message), on: () => {}}
  connectStore(model)
  const serve = async (/** @type {Window} */ value, /** @type {number} */ count) => {
    data.setv({window: {value, count}})
    await settled()
  }
  const move = async (/** @type {Window} */ {xLow, xHigh, ordinateLow, ordinateHigh}) => {
    for (const [range, ends] of /** @type {[Model, object][]} */ ([
      [x, {start: xLow}],
      [x, {end: xHigh}],
      [y, {start: ordinateLow, end: ordinateHigh}],
    ]))
      range.setv(ends)
    await settled()
  }
  const ends = () => /** @type {any[]} */ ([x, y]).flatMap(({start, end}) => [start, end])
  return {store: storeOf(bokehDocument), sent, serve, move, ends, rest: () => models.basins.events.get("rangesupdate")?.()}
}

/** Wait for the calls at the end of a task. */
const settled = async () => {
  for (let k = 0; k < 5; k++) await null
}

beforeEach(() => {
  mock.timers.enable({apis: ["setTimeout"]})
  globalThis.document = /** @type {any} */ (new EventTarget())
})
afterEach(() => mock.timers.reset())

test("the ranges show the window of the server at once, and later ones", async () => {
  const {serve, ends, sent} = makePage()
  assert.deepEqual(ends(), [-1, 1, -1, 1])
  await serve(CLOSER, 0)
  assert.deepEqual(ends(), [-0.5, 0.5, -1, 1])
  mock.timers.tick(1000)
  assert.deepEqual(sent, [])
})

test("a move is sent once, when the ranges rest, and all parts of the page see it before", async () => {
  const {store, sent, move} = makePage()
  const seen = /** @type {any[]} */ ([])
  store.window.listen(() => seen.push(store.window.value))
  await move(CLOSER)
  mock.timers.tick(60)
  await move(makeWindow(-0.1, 0.1))
  mock.timers.tick(60)
  assert.deepEqual(sent, [])
  mock.timers.tick(60)
  assert.deepEqual(sent, [{name: "window", value: makeWindow(-0.1, 0.1), count: 1, done: false}])
  assert.deepEqual(seen, [CLOSER, makeWindow(-0.1, 0.1)])
})

test("a window that is chosen elsewhere drops a move that is not sent", async () => {
  const {serve, move, ends, sent} = makePage()
  await move(CLOSER)
  await serve(makeWindow(-0.2, 0.2), 1)
  assert.deepEqual(ends(), [-0.2, 0.2, -1, 1])
  mock.timers.tick(1000)
  assert.deepEqual(sent, [])
  await move(CLOSER)
  mock.timers.tick(100)
  assert.deepEqual(
    sent.map(({count}) => count),
    [2],
  )
})

test("a window that is chosen elsewhere replaces a move that the server ignores", async () => {
  const {serve, move, ends} = makePage()
  await move(CLOSER)
  mock.timers.tick(100)
  await serve(makeWindow(-0.2, 0.2), 1)
  assert.deepEqual(ends(), [-0.2, 0.2, -1, 1])
})

test("a window that the server shows late does not undo later moves", async () => {
  const {serve, move, ends, sent} = makePage()
  await move(CLOSER)
  mock.timers.tick(100)
  await move(makeWindow(-0.1, 0.1))
  await serve(CLOSER, 1)
  assert.deepEqual(ends(), [-0.1, 0.1, -1, 1])
  mock.timers.tick(100)
  assert.deepEqual(sent[1].value, makeWindow(-0.1, 0.1))
})

test("the ranges do not follow an earlier map, but return when the server refuses the window", async () => {
  const {serve, move, ends} = makePage()
  await move(CLOSER)
  mock.timers.tick(100)
  await serve(makeWindow(-0.9, 0.9), 0)
  assert.deepEqual(ends(), [-0.5, 0.5, -1, 1])
  await serve(HOME, 2)
  assert.deepEqual(ends(), [-1, 1, -1, 1])
})

test("a step within the pause belongs to the same gesture", async () => {
  const {move, rest, sent} = makePage()
  const gestures = () => sent.filter(({gesture}) => gesture)
  await move(CLOSER)
  rest()
  assert.equal(sent.length, 1)
  mock.timers.tick(400)
  await move(makeWindow(-0.1, 0.1))
  mock.timers.tick(1000)
  assert.deepEqual(gestures(), [])
  rest()
  rest()
  mock.timers.tick(500)
  assert.deepEqual(gestures(), [{gesture: "end"}])
  rest()
  mock.timers.tick(500)
  assert.equal(gestures().length, 1)
})

test("a preview shows another window, and is not sent", async () => {
  const {store, sent, ends, serve} = makePage()
  store.window.show(CLOSER)
  await settled()
  assert.deepEqual(ends(), [-0.5, 0.5, -1, 1])
  await serve(makeWindow(-0.2, 0.2), 0)
  mock.timers.tick(1000)
  assert.deepEqual([ends(), sent], [[-0.2, 0.2, -1, 1], []])
})

test("an energy is shared before it is sent", async () => {
  const {store, sent} = makePage()
  let calls = 0
  const ignore = store.energy.listen(() => calls++)
  store.energy.hold(0.2)
  store.energy.hold(0.3)
  await settled()
  assert.deepEqual([calls, store.energy.value, store.energy.isNewer, sent], [1, 0.3, true, []])
  store.energy.finish()
  assert.deepEqual(sent, [{name: "energy", value: 0.3, count: 1, done: true}])
  ignore()
  store.energy.hold(0.4)
  await settled()
  assert.equal(calls, 1)
})

test("a document has one store, and another document its own", async () => {
  const [one, other] = [makePage(), makePage()]
  one.store.energy.hold(0.4)
  await one.move(CLOSER)
  assert.deepEqual([other.store.energy.value, other.ends()], [0.19, [-1, 1, -1, 1]])
})
