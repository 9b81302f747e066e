// @ts-check
/**
 * What is drawn over the pictures follows them on the screen.
 *
 * No event reports all moves: windows, layers and panels change the layout, and Bokeh follows later. Therefore places are compared
 * before each repaint of the screen, but only from an event that can move pictures until they have been at rest for a while: a page
 * at rest asks for no frames.
 */

/** Time without a change after which pictures are at rest, in ms. */
const AT_REST_MS = 1000

/** Events of the document, and of the window, after which pictures may move. */
const DOCUMENT_EVENTS = ["pointerdown", "pointermove", "pointerup", "keydown", "keyup", "wheel", "scroll", "toggle"]
const WINDOW_EVENTS = ["resize", "pageshow", "hashchange"]

/** The functions that compare places, and return whether these have changed. @type {Set<() => boolean>} */
const followers = new Set()
let request = 0
let lastChange = 0
let isListening = false

/**
 * Call a function with places on the screen whenever these have changed.
 *
 * @template Places
 * @param {() => Places} find  the places, as plain values
 * @param {(places: Places) => void} draw
 * @returns {() => void} a function that ends the calls
 */
export function follow(find, draw) {
  let last = ""
  const compare = () => {
    const places = find()
    const state = JSON.stringify(places)
    const hasChanged = state !== last
    last = state
    if (hasChanged) draw(places)
    return hasChanged
  }
  followers.add(compare)
  if (!isListening) listen()
  // A notebook adds a document with each explorer. A function that listens already is not added again.
  for (const each of Bokeh.documents) each.on_change(wake)
  wake()
  return () => followers.delete(compare)
}

/** Compare places from now on, until they have been at rest for a while. */
export function wake() {
  lastChange = performance.now()
  request ||= requestAnimationFrame(compareAll)
}

function compareAll() {
  const now = performance.now()
  for (const compare of followers) if (compare()) lastChange = now
  request = now - lastChange < AT_REST_MS ? requestAnimationFrame(compareAll) : 0
}

/** Listen to all that can move pictures, except documents, as long as the page exists. */
function listen() {
  isListening = true
  const options = {capture: true, passive: true}
  for (const name of DOCUMENT_EVENTS) document.addEventListener(name, wake, options)
  for (const name of WINDOW_EVENTS) addEventListener(name, wake, options)
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", wake)
  new ResizeObserver(wake).observe(document.body)
}
