// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {offsetLabel} from "../../../../app/views/components/offset_ticks.js"

test("a label is the distance from the base in units", () => {
  assert.equal(offsetLabel(0.300643524602, 0.3006435246, 1e-12), "2")
  assert.equal(offsetLabel(0.3006435246, 0.3006435246, 1e-12), "0")
})

test("a negative distance has a typographic minus sign", () => {
  assert.equal(offsetLabel(0.3006435242, 0.3006435246, 1e-10), "−4")
})
