// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {connectGestures} from "../../../plots/browser/modules/figure/gestures.js"

/** Connect gestures on a canvas of 100 × 100 pixels, and return a function that sends an event, and the calls of actions. */
function connected() {
  /** @type {Record<string, (event: any) => void>} */
  const listeners = {}
  /** @type {[string, any[]][]} */
  const calls = []
  const canvas = /** @type {any} */ ({
    addEventListener: (/** @type {string} */ name, /** @type {any} */ listener) => (listeners[name] = listener),
    setPointerCapture: () => {},
  })
  const record =
    (/** @type {string} */ name) =>
    (/** @type {any[]} */ ...values) =>
      void calls.push([name, values])
  const frame = () => /** @type {any} */ ({left: 0, top: 0, bottom: 100, width: 100, height: 100})
  const actions = {
    point: record("point"),
    choose: record("choose"),
    move: record("move"),
    zoom: record("zoom"),
    reset: record("reset"),
  }
  connectGestures(canvas, frame, actions)
  const send = (/** @type {string} */ name, /** @type {object} */ event) =>
    listeners[name]({type: name, preventDefault: () => {}, pointerType: "mouse", pointerId: 1, ...event})
  return {send, calls}
}

test("a click chooses the place, counted from the lower left corner", () => {
  const {send, calls} = connected()
  send("pointerdown", {clientX: 20, clientY: 10})
  send("pointerup", {clientX: 20, clientY: 10})
  assert.deepEqual(calls, [["choose", [[0.2, 0.9]]]])
})

test("a drag moves the picture and chooses nothing", () => {
  const {send, calls} = connected()
  send("pointerdown", {clientX: 20, clientY: 10})
  send("pointermove", {clientX: 40, clientY: 20})
  send("pointerup", {clientX: 40, clientY: 20})
  assert.deepEqual(calls, [["move", [[0.2, -0.1]]]])
})

test("one finger scrolls the page, and two zoom about the point between them", () => {
  const {send, calls} = connected()
  const finger = (/** @type {number} */ pointerId, /** @type {number} */ clientX) => ({
    pointerType: "touch",
    pointerId,
    clientX,
    clientY: 50,
  })
  send("pointerdown", finger(1, 40))
  send("pointermove", finger(1, 60))
  assert.equal(calls.length, 0)
  send("pointerdown", finger(2, 80))
  send("pointermove", finger(2, 100))
  assert.equal(calls[0][0], "zoom")
  assert.ok(calls[0][1][0] < 1)
  send("pointerup", finger(1, 60))
  send("pointerup", finger(2, 100))
  assert.ok(calls.every(([name]) => name !== "choose"))
})

test("the wheel keeps the place under the pointer", () => {
  const {send, calls} = connected()
  send("wheel", {clientX: 25, clientY: 25, deltaY: 400})
  assert.deepEqual(calls, [["zoom", [Math.E, [0.25, 0.75]]]])
})

test("keys move, zoom and choose", () => {
  const {send, calls} = connected()
  send("keydown", {key: "ArrowRight"})
  send("keydown", {key: "ArrowUp", shiftKey: true})
  send("keydown", {key: "Enter"})
  send("keydown", {key: "0"})
  assert.deepEqual(
    calls.map(([name]) => name),
    ["move", "point", "choose", "reset"],
  )
  assert.deepEqual(calls[0][1], [[-0.1, -0]])
  assert.deepEqual(calls[2][1], [[0.5, 0.51]])
})
