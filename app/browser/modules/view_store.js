// @ts-check
/** Energy and window in view, which the inputs, the player, the pictures and the previews of a page share. */

import {SharedValue} from "./counted_value.js"

/** Time without change after which the server computes what it shows of a view at rest, in ms. */
export const VIEW_REST_MS = 2000

/**
 * The values, and a function that sends a message to the component, see `app/views/components/view_store.py`.
 *
 * @typedef {object} ViewStore
 * @property {SharedValue} energy
 * @property {SharedValue} window  an `engine/starts.Window`; null until it is known
 * @property {(message: object) => void} send  set by the component, before any message
 * @property {Rail | null} rail  set by the slider of the energy; null without a slider
 *
 * The slider of the energy, and the canvas behind it.
 *
 * @typedef {{slider: HTMLInputElement, canvas: HTMLCanvasElement}} Rail
 */

/**
 * Return the store of a document of Bokeh. Another document on the same page has its own store.
 *
 * @param {any} bokehDocument
 * @returns {ViewStore}
 */
export function storeOf(bokehDocument) {
  const model = bokehDocument.get_model_by_name("BrowserEngine")
  return (model.store ??= makeStore(model.data))
}

/** @param {any} data  the parameters of the component @returns {ViewStore} */
function makeStore(data) {
  const share = (/** @type {"energy" | "window"} */ name) => {
    const value = new SharedValue({
      get shown() {
        return data[name]
      },
      send_msg: (/** @type {object} */ message) => store.send({name, ...message}),
    })
    data.connect(data.properties[name].change, () => value.follow())
    return value
  }
  /** @type {ViewStore} */
  const store = {energy: share("energy"), window: share("window"), send: () => {}, rail: null}
  return store
}
