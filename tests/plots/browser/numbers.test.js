// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {count, number, percent} from "../../../plots/browser/modules/numbers.js"

test("a number has four digits and typographic signs", () => {
  const cases = [0.000012345, 1234.56, 0, -0.5, 123456, -1.9e-12, 20000]
  assert.deepEqual(
    cases.map(value => number(value)),
    ["1.234 × 10⁻⁵", "1\u202f235", "0", "−0.5", "1.235 × 10⁵", "−1.9 × 10⁻¹²", "20\u202f000"],
  )
  assert.equal(number(Math.PI, 2), "3.1")
  assert.equal(number(1234.5678), "1\u202f235")
})

test("a whole number has groups of digits", () => {
  assert.deepEqual([count(1234567), count(12), count(-1234)], ["1\u202f234\u202f567", "12", "−1\u202f234"])
})

test("a share has three digits", () => {
  assert.deepEqual([percent(0.12345), percent(0)], ["12.3\u202f%", "0\u202f%"])
})
