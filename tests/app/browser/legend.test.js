// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {fade} from "../../../app/browser/modules/legend.js"

test("all colours fade but the one of the item", () => {
  assert.deepEqual(fade(["#102030", "#405060", "#708090ff"], "#405060"), ["#1020302e", "#405060", "#7080902e"])
})

test("every pixel of the item's colour stays", () => {
  assert.deepEqual(fade(["#405060", "#102030", "#405060"], "#405060"), ["#405060", "#1020302e", "#405060"])
})
