// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {Local} from "../../../app/browser/modules/painting/local.js"

/** A model of Bokeh with one property. */
class Model {
  data = "server"
  properties = {data: {change: "change"}}
  /** @type {string[]} */
  sent = []
  /** @type {() => void} */
  changed = () => {}

  /** @param {any} _signal @param {() => void} slot */
  connect(_signal, slot) {
    this.changed = slot
  }

  /** @param {Record<string, any>} values @param {{sync: boolean}} [options] */
  setv({data}, {sync} = {sync: true}) {
    this.data = data
    if (sync) this.sent.push(data)
    this.changed()
  }
}

test("local values are not sent, and the server's come back", () => {
  const model = new Model()
  const local = new Local(/** @type {any} */ (model), ["data"])
  local.show({data: "preview"})
  assert.equal(model.data, "preview")
  local.restore()
  assert.equal(model.data, "server")
  assert.deepEqual(model.sent, [])
})

test("values of the server that equal those of the preview stay", () => {
  const model = new Model()
  const local = new Local(/** @type {any} */ (model), ["data"])
  local.show({data: "frame"})
  local.settle({data: "frame"})
  local.restore()
  assert.equal(model.data, "frame")
  local.show({data: "preview"})
  local.restore()
  assert.equal(model.data, "frame")
})

test("a change of the server is known, and can be left out of sight", () => {
  const model = new Model()
  let changes = 0
  const local = new Local(/** @type {any} */ (model), ["data"], () => changes++)
  local.show({data: "preview"})
  model.setv({data: "frame"})
  assert.equal(changes, 1)
  local.keepPreview()
  assert.deepEqual([model.data, local.server], ["preview", {data: "frame"}])
  local.restore()
  assert.equal(model.data, "frame")
})
