// @ts-check
import assert from "node:assert/strict"
import {test} from "node:test"

import {render} from "../../../../app/browser/components/image_copier.js"

/** @param {((items: any[]) => Promise<void>) | undefined} write */
function makeButton(write) {
  /** @type {any} */
  const button = {
    addEventListener: (/** @type {string} */ _, /** @type {() => Promise<void>} */ listen) => (button.click = listen),
  }
  const sent = /** @type {any[]} */ ([])
  const model = {
    label: "Copy image",
    send_msg: (/** @type {any} */ message) => sent.push(message),
    on: (/** @type {string} */ _, /** @type {(message: any) => void} */ receive) => (button.receive = receive),
  }
  Object.defineProperty(globalThis, "navigator", {value: {clipboard: write && {write}}, configurable: true})
  Object.assign(globalThis, {
    document: {createElement: () => button},
    ClipboardItem: class {
      /** @param {any} parts */
      constructor(parts) {
        this.parts = parts
      }
    },
  })
  render({model, el: /** @type {any} */ ({append: () => {}})})
  return {button, sent}
}

test("the image that the server sends is copied", async () => {
  /** @type {Blob | undefined} */
  let copied
  const {button, sent} = makeButton(async ([item]) => {
    copied = await item.parts["image/png"]
  })
  const done = button.click()
  button.click()
  assert.deepEqual(sent, [{wanted: true}])
  button.receive({image: new Uint8Array([1, 2, 3]).buffer})
  await done
  assert.deepEqual(sent, [{wanted: true}, {copied: true}])
  assert.deepEqual([copied?.size, copied?.type], [3, "image/png"])
})

test("without an image nothing is said, and the next click asks again", async () => {
  const {button, sent} = makeButton(([item]) => item.parts["image/png"])
  for (let click = 0; click < 2; click++) {
    const done = button.click()
    button.receive({image: null})
    await done
  }
  assert.deepEqual(sent, [{wanted: true}, {wanted: true}])
})

test("a browser that refuses says so", async () => {
  const {button, sent} = makeButton(() => Promise.reject(new Error("not allowed")))
  const done = button.click()
  button.receive({image: new ArrayBuffer(1)})
  await done
  assert.deepEqual(sent, [{wanted: true}, {copied: false}])
})

test("a browser without a clipboard does not ask the server", async () => {
  const {button, sent} = makeButton(undefined)
  await button.click()
  assert.deepEqual(sent, [{copied: false}])
})
