// @ts-check
/** Loads the modules of the engine, which the server serves as files, when the page has a system and is idle. */

import {connectStore} from "../components/view_store.js"

/** Longest wait for an idle page, in ms. */
const LONGEST_WAIT_MS = 2000

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  el.setAttribute("aria-hidden", "true")
  connectStore(model)
  const load = () => void import(new URL(model.address, document.baseURI).href).then(({start}) => start(model, el))
  // Safari has no requestIdleCallback.
  const rest = globalThis.requestIdleCallback ?? setTimeout
  // The server sends a system with the view, or after the first frame of a map.
  let loading = false
  const begin = () => {
    if (loading || !model.system.key) return
    loading = true
    rest(load, {timeout: LONGEST_WAIT_MS})
  }
  model.on("system", begin)
  begin()
}
