// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {coordinate, fateName, pixelDetails} from "../../../../app/views/maps/hover_texts.js"

const CODES = {bounded: 4, firstDifference: 5, firstEvidence: 10}
const WORDS = {
  evidence: ["integrated", "enclosed"],
  layers: {
    character: ["", "", "", "", "", "regular", "chaotic"],
    passage: [],
    trust: ["not tested", "doubtful"],
  },
  values: {length_value: "length"},
  fates: ["undecided", "failed", "outside", "forbidden", "bounded", "exit 1", "exit 2"],
}
const none = [new Uint8Array(1)]

/** Two pixels: a bounded one and one that escapes. */
const maps = {
  fate: [Uint8Array.of(4, 6)],
  escape_time: [Float32Array.of(NaN, 12.345678)],
  crossings: [Uint8Array.of(0, 1)],
  crossing_class: [Uint8Array.of(11, 6)],
  crossing_words: [["upward crossing of y = 0", "upward crossings of y = 0"]],
  character: none,
  passage: none,
  passage_words: [["", "", "", "", "", "never entered", "entered through exit 2"]],
  trust: none,
  length_value: none,
  difference: none,
  x: [-1],
  y: [-1],
  dw: [2],
  dh: [1],
}
const other = {fate: [Uint8Array.of(5, 6)], x: [-1], y: [-1], dw: [2], dh: [1]}
const details = (/** @type {number} */ pixel, /** @type {object} */ layers = {}, /** @type {object} */ compared = other) =>
  pixelDetails(pixel, {maps: {...maps, ...layers}, compared}, CODES, WORDS).split("\n")

test("an escaping pixel has its time and crossings", () => {
  assert.deepEqual(details(1), ["escape time 12.35", "1 upward crossing of y = 0"])
})

test("a bounded pixel has its evidence", () => {
  assert.deepEqual(details(0), ["enclosed"])
})

test("layers add what they know of a pixel", () => {
  const layers = {character: [Uint8Array.of(6, 0)], passage: [Uint8Array.of(5, 6)], trust: [Uint8Array.of(1, 0)]}
  assert.deepEqual(details(0, layers), ["enclosed", "chaotic", "never entered", "doubtful"])
  assert.ok(details(1, layers).includes("entered through exit 2"))
  assert.ok(details(1, {length_value: [Float32Array.of(NaN, 2.5)]}).includes("length 2.5"))
  assert.deepEqual(details(0, {length_value: [Float32Array.of(NaN, 2.5)]}), ["enclosed"])
})

test("a pixel that is compared has its end in the other view", () => {
  const layers = {difference: [Uint8Array.of(6, 5)]}
  assert.deepEqual(details(0, layers), ["enclosed", "other view: exit 1"])
  assert.deepEqual(details(0, layers, {...other, x: [-2]}), ["enclosed"])
})

test("an end has the words of its map, also in the other view", () => {
  const ends = [["", "escapes through exit 2", "", "", "", "", "", "", "collides with a disc"]]
  const names = WORDS.fates.slice(0, 5)
  assert.equal(fateName(6, names, {ends}), "escapes through exit 2")
  assert.equal(fateName(13, names, {ends}), "collides with a disc")
  assert.equal(fateName(7, names, {ends}), "undecided")
})

test("an outcome that is no orbit has no details", () => {
  assert.deepEqual(details(0, {fate: [Uint8Array.of(3, 6)]}), [""])
})

test("a coordinate distinguishes neighbouring pixels", () => {
  assert.equal(coordinate(0.123456789, {start: 0, end: 1}), "0.123")
  assert.equal(coordinate(0.123456789, {start: 0.1234567, end: 0.1234569}), "0.1234567890")
})

test("a coordinate has the minus sign of the other numbers", () => {
  assert.equal(coordinate(-0.2, {start: -1, end: 1}), "−0.200")
})
