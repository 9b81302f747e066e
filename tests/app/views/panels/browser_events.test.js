// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {render} from "../../../../app/views/panels/browser_events.js"

/** @typedef {{state: any, link: string}} Entry */

/** A browser without keys, touch or a phone: its history, and what the page sends and listens to. */
function open_page() {
  /** @type {Entry[]} */
  const entries = [{state: null, link: "?"}]
  let place = 0
  /** @type {Record<string, (event: any) => void>} */
  const heard = {}
  const listen = {addEventListener: (/** @type {string} */ name, /** @type {any} */ slot) => void (heard[name] = slot)}
  const history = {
    replaceState: (/** @type {any} */ state, /** @type {string} */ _, link = entries[place].link) =>
      void (entries[place] = {state, link}),
    pushState: (/** @type {any} */ state, /** @type {string} */ _, /** @type {string} */ link) => {
      entries.splice(++place, entries.length, {state, link})
    },
  }
  const location = {
    get search() {
      return entries[place].link
    },
  }
  const document = {...listen, documentElement: {dataset: {}}, querySelector: () => null}
  Object.assign(globalThis, {document, history, window: {...listen, location}, matchMedia: () => ({matches: false})})
  /** @type {any[]} */
  const sent = []
  const model = {
    address: {},
    on: (/** @type {string} */ name, /** @type {any} */ slot) => void (heard[name] = slot),
    send_msg: (/** @type {any} */ message) => sent.push(message),
  }
  render({model, el: /** @type {any} */ ({setAttribute() {}})})
  return {
    sent,
    links: () => entries.map(({link}) => link),
    write(/** @type {string} */ link, /** @type {number} */ entry, /** @type {number} */ steps) {
      model.address = {link, entry, steps}
      heard.address({})
    },
    go_back() {
      place--
      heard.popstate({state: entries[place].state})
    },
  }
}

test("a new number is a new entry of the history, and the same one replaces the address", () => {
  const page = open_page()
  page.write("?h=0.1", 0, 0)
  page.write("?h=0.2", 1, 0)
  page.write("?h=0.3", 1, 0)
  assert.deepEqual(page.links(), ["?h=0.1", "?h=0.3"])
})

test("an address is written only if the server knew of the last step through the history", () => {
  const page = open_page()
  page.write("?h=0.1", 0, 0)
  page.write("?h=0.2", 1, 0)
  page.go_back()
  assert.deepEqual(page.sent, [{link: "?h=0.1", entry: 0, steps: 1}])
  page.write("?h=0.3", 2, 0)
  assert.deepEqual(page.links(), ["?h=0.1", "?h=0.2"])
  page.write("?h=0.4", 1, 1)
  assert.deepEqual(page.links(), ["?h=0.1", "?h=0.4"])
})
