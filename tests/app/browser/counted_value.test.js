// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"
import {CountedValue} from "../../../app/browser/modules/counted_value.js"

/** An input whose server has set a value before any of the visitor. */
function makeInput() {
  const input = {text: ""}
  const sent = /** @type {any[]} */ ([])
  const model = {shown: {value: "first", count: 0}, send_msg: (/** @type {any} */ message) => sent.push(message)}
  const value = new CountedValue(
    model,
    () => input.text,
    text => (input.text = text),
  )
  const show = (/** @type {string} */ text, /** @type {number} */ count) => {
    model.shown = {value: text, count}
    value.follow()
  }
  return {input, sent, value, show}
}

test("an older value of the server does not replace one that is sent", () => {
  const {input, sent, value, show} = makeInput()
  for (const text of ["a", "ab"]) {
    input.text = text
    value.change()
  }
  show("a", 1)
  assert.equal(input.text, "ab")
  show("server", 2)
  assert.equal(input.text, "server")
  assert.deepEqual(sent, [
    {value: "a", count: 1, done: false},
    {value: "ab", count: 2, done: false},
  ])
})

test("no value of the server replaces one that is not sent yet", () => {
  const {input, sent, value, show} = makeInput()
  input.text = "mine"
  value.begin()
  show("server", 0)
  assert.equal(input.text, "mine")
  value.finish()
  value.finish()
  assert.deepEqual(sent, [{value: "mine", count: 1, done: true}])
})

test("a value that is dropped gives way to that of the server", () => {
  const {input, sent, value, show} = makeInput()
  input.text = ""
  value.begin()
  show("server", 0)
  value.cancel()
  assert.deepEqual([input.text, sent], ["server", []])
})

test("a change is done once", () => {
  const {input, sent, value} = makeInput()
  value.finish()
  input.text = "x"
  value.change()
  value.finish()
  value.finish()
  assert.deepEqual(
    sent.map(({count, done}) => [count, done]),
    [
      [1, false],
      [2, true],
    ],
  )
})

test("a value that the server has chosen since replaces one that is not sent yet, and is counted", () => {
  const {input, sent, value, show} = makeInput()
  input.text = "mine"
  value.begin()
  show("chosen", 1)
  assert.deepEqual([input.text, value.isNewer], ["chosen", false])
  value.change()
  assert.equal(sent[0].count, 2)
})
