// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {Pool} from "../../../plots/browser/modules/workers/pool.js"

/** A worker that answers when it is told to. */
class SlowWorker {
  /** @type {any[]} */
  received = []
  /** @type {(event: {data: any}) => void} */
  onmessage = () => {}

  /** @param {any} message */
  postMessage(message) {
    this.received.push(message)
  }

  answer() {
    this.onmessage({data: "pixels"})
  }
}

Object.defineProperty(globalThis, "navigator", {value: {hardwareConcurrency: 2}})

function startPool() {
  /** @type {SlowWorker[]} */
  const workers = []
  const pool = new Pool(() => {
    const worker = new SlowWorker()
    workers.push(worker)
    return /** @type {any} */ (worker)
  })
  return {pool, workers}
}

const view = /** @type {any} */ ("view")
const parts = (/** @type {number} */ count) => /** @type {any[]} */ (Array.from({length: count}, (_, k) => k + 1))

test("workers start with the first system, one on each core", () => {
  const {pool, workers} = startPool()
  assert.equal(workers.length, 0)
  pool.setSystem(/** @type {any} */ ("system"), /** @type {any} */ ("modules"))
  assert.equal(workers.length, 2)
  assert.deepEqual(workers[0].received, [{system: "system", modules: "modules"}])
})

test("a worker has one part at a time, and all parts are computed", () => {
  const {pool, workers} = startPool()
  pool.setSystem(/** @type {any} */ ("system"), /** @type {any} */ ("modules"))
  /** @type {any[]} */
  const done = []
  pool.compute(view, parts(3), part => done.push(part))
  assert.deepEqual(
    workers.map(({received}) => received.length),
    [2, 2],
  )
  workers[1].answer()
  assert.deepEqual(
    workers.map(({received}) => received.length),
    [2, 3],
  )
  workers[1].answer()
  workers[0].answer()
  assert.deepEqual(done.sort(), [1, 2, 3])
})

test("another picture drops the parts that wait, and the pixels under way", () => {
  const {pool, workers} = startPool()
  pool.setSystem(/** @type {any} */ ("system"), /** @type {any} */ ("modules"))
  /** @type {any[]} */
  const done = []
  pool.compute(view, parts(9), part => done.push(["old", part]))
  pool.compute(view, parts(2), part => done.push(["new", part]))
  for (const worker of [...workers, ...workers]) worker.answer()
  assert.deepEqual(done, [
    ["new", 1],
    ["new", 2],
  ])
})
