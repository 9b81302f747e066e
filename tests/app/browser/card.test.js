// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {pathOf} from "../../../app/browser/modules/card.js"

test("the path of an orbit is in units of the page", () => {
  assert.deepEqual(pathOf({x: [0.5, 1], y: [-1, 0.25]}, {length: 4}), {xs: [2, 4], ys: [-4, 1]})
})
