// @ts-check
/**
 * Gestures on the picture of a map. The mouse shows and chooses orbits, drags and zooms. One finger chooses orbits and scrolls the
 * page, two fingers move and zoom the map. Keys move, zoom and choose.
 *
 * @typedef {[number, number]} Place  shares of the width from the left and of the height from the bottom
 *
 * @typedef {object} Actions
 * @property {(place: Place | null) => void} point  the pointer is at a place; null if it has left
 * @property {(place: Place) => void} choose
 * @property {(move: [number, number]) => void} move  the picture moves by shares of its sides, to the right and up
 * @property {(factor: number, place: Place) => void} zoom  the sides of the window are multiplied, and a place stays
 * @property {() => void} reset
 */

/** Largest movement of a click, in pixels. */
const CLICK_PIXELS = 5
/** Change of the logarithm of a side for each pixel of the wheel, and factor of a key. */
const WHEEL_RATE = 1 / 400
const KEY_FACTOR = 1.25
/** Share of a side by which a key moves the picture, and the place that is chosen. */
const KEY_MOVE = 0.1
const FINE_MOVE = 0.01

/**
 * Connect the gestures on a canvas with actions.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {() => DOMRect} frame  the frame of the picture on the screen
 * @param {Actions} actions
 */
export function connectGestures(canvas, frame, actions) {
  connectPointers(canvas, frame, actions)
  canvas.addEventListener(
    "wheel",
    event => {
      const place = placeOf(event, frame())
      if (!isInside(place)) return
      event.preventDefault()
      actions.zoom(Math.exp(event.deltaY * WHEEL_RATE), place)
    },
    {passive: false},
  )
  canvas.addEventListener("dblclick", () => actions.reset())
  canvas.addEventListener("pointerleave", () => actions.point(null))
  connectKeys(canvas, actions)
}

/** @type {typeof connectGestures} */
function connectPointers(canvas, frame, actions) {
  /** The pressed pointers. @type {Map<number, {x: number, y: number}>} */
  const pressed = new Map()
  let hasMoved = false
  canvas.addEventListener("pointerdown", event => {
    if (!isInside(placeOf(event, frame()))) return
    canvas.setPointerCapture(event.pointerId)
    pressed.set(event.pointerId, {x: event.clientX, y: event.clientY})
    hasMoved = pressed.size > 1
  })
  canvas.addEventListener("pointermove", event => {
    const before = pressed.get(event.pointerId)
    const place = placeOf(event, frame())
    if (!before) {
      actions.point(isInside(place) ? place : null)
      return
    }
    const after = {x: event.clientX, y: event.clientY}
    if (!hasMoved && Math.hypot(after.x - before.x, after.y - before.y) < CLICK_PIXELS) return
    hasMoved = true
    // One finger scrolls the page.
    if (event.pointerType === "touch" && pressed.size === 1) return
    const {width, height} = frame()
    const share = 1 / pressed.size
    const other = [...pressed].find(([id]) => id !== event.pointerId)?.[1]
    if (other) {
      const distances = [before, after].map(({x, y}) => Math.max(Math.hypot(x - other.x, y - other.y), 1))
      const middle = {clientX: (after.x + other.x) / 2, clientY: (after.y + other.y) / 2}
      actions.zoom(distances[0] / distances[1], placeOf(middle, frame()))
    }
    actions.move([((after.x - before.x) * share) / width, ((before.y - after.y) * share) / height])
    pressed.set(event.pointerId, after)
  })
  const release = (/** @type {PointerEvent} */ event) => {
    if (!pressed.delete(event.pointerId) || event.type !== "pointerup" || hasMoved) return
    actions.choose(placeOf(event, frame()))
  }
  canvas.addEventListener("pointerup", release)
  canvas.addEventListener("pointercancel", release)
}

/**
 * Connect the keys: arrows move the picture, with Shift the place that Enter chooses; + and − zoom, 0 shows the whole map.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Actions} actions
 */
function connectKeys(canvas, actions) {
  /** @type {Place} */
  let place = [0.5, 0.5]
  /** @type {Record<string, [number, number]>} */
  const directions = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}
  canvas.addEventListener("keydown", event => {
    const direction = directions[event.key]
    if (direction && event.shiftKey) {
      place = [clip(place[0] + FINE_MOVE * direction[0]), clip(place[1] + FINE_MOVE * direction[1])]
      actions.point(place)
    } else if (direction) actions.move([-KEY_MOVE * direction[0], -KEY_MOVE * direction[1]])
    else if (event.key === "Enter") actions.choose(place)
    else if (event.key === "+" || event.key === "=") actions.zoom(1 / KEY_FACTOR, place)
    else if (event.key === "-") actions.zoom(KEY_FACTOR, place)
    else if (event.key === "0") actions.reset()
    else return
    event.preventDefault()
  })
}

/** @type {(point: {clientX: number, clientY: number}, frame: DOMRect) => Place} */
const placeOf = ({clientX, clientY}, {left, bottom, width, height}) => [(clientX - left) / width, (bottom - clientY) / height]

/** @type {(place: Place) => boolean} */
const isInside = place => place.every(share => share >= 0 && share <= 1)

/** @type {(share: number) => number} */
const clip = share => Math.min(Math.max(share, 0), 1)
