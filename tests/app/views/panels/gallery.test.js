// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"
import {matches} from "../../../../app/views/panels/gallery.js"

const card = {
  key: "sticky",
  group: "The paper",
  title: "A sticky orbit",
  caption: "Regular, then gone.",
  line: "",
  alt: "case I",
  thumbnail: "",
}

test("all words of a search are in the texts of a card, in any order and case", () => {
  for (const search of ["", "Sticky", "paper sticky ", "case regular"]) assert.ok(matches(card, search), search)
  for (const search of ["tokamak", "sticky tokamak"]) assert.ok(!matches(card, search), search)
})
