// @ts-check
/** Connects the store of energy and window with the server, and with the ranges of the maps, which only the browser moves. */

import {storeOf} from "../../browser/modules/view_store.js"

/** Time without change after which a window is sent, in ms. Steps of the wheel are closer together. */
const REST_MS = 90
/** Longest pause between drags or steps of the wheel that share an entry of the browser's history, in ms. */
const GESTURE_PAUSE_MS = 500

/** Events at which a touch ends. */
const TOUCH_ENDS = ["touchend", "touchcancel"]

/** @param {any} model  of the component */
export function connectStore(model) {
  const store = storeOf(model.document)
  store.send = message => model.send_msg(message)
  const {window: shared} = store
  // All maps share these ranges.
  const figure = model.document.get_model_by_name("basins")
  const {x_range: x, y_range: y} = figure
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let rest
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let pause
  let isFollowing = false
  const follow = () => {
    if (!shared.value) return
    const {xLow, xHigh, ordinateLow, ordinateHigh} = shared.value
    isFollowing = true
    x.setv({start: xLow, end: xHigh}, {sync: false})
    y.setv({start: ordinateLow, end: ordinateHigh}, {sync: false})
    isFollowing = false
  }
  const send = () => {
    clearTimeout(rest)
    if (shared.isUnsent) shared.send()
  }
  const take = () => {
    if (isFollowing || !shared.value) return
    for (const timer of [rest, pause]) clearTimeout(timer)
    shared.hold({xLow: x.start, xHigh: x.end, ordinateLow: y.start, ordinateHigh: y.end})
    rest = setTimeout(send, REST_MS)
  }
  const endGesture = () => {
    if (shared.isFinal) return
    send()
    clearTimeout(pause)
    pause = setTimeout(() => {
      shared.isFinal = true
      model.send_msg({gesture: "end"})
    }, GESTURE_PAUSE_MS)
  }
  const ignore = shared.listen(follow)
  for (const range of [x, y]) for (const name of ["start", "end"]) range.connect(range.properties[name].change, take)
  // Bokeh reports the end of a drag at once, and a step of the wheel after half a second, but not the end of a touch by two fingers.
  figure.on_event("rangesupdate", endGesture)
  for (const name of TOUCH_ENDS) document.addEventListener(name, endGesture)
  model.on("lifecycle:remove", () => {
    ignore()
    for (const name of TOUCH_ENDS) document.removeEventListener(name, endGesture)
  })
  follow()
}
