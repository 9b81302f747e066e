// @ts-check
/** Measurements in the page, for `benchmarks/drag.py`. */

const frame = () => new Promise(requestAnimationFrame)

/** The player of many orbits. @returns {any} */
const findPlayer = () =>
  [...Bokeh.documents[0]._all_models.values()].find(model => model.data?.attributes && "seed" in model.data.attributes)

/** @type {Map<number, number>} */
const moved = new Map()
/** @type {number[]} */
const delays = []
/** @type {number[]} */
const sides = []
let sent = 0

const send = WebSocket.prototype.send
WebSocket.prototype.send = function (data) {
  sent++
  return send.call(this, data)
}

/** Canvases over the pictures that are observed. */
const observed = new Set()
const observer = new MutationObserver(records => {
  const {energy, side} = /** @type {HTMLElement} */ (records[0].target).dataset
  const begun = moved.get(Number(energy))
  if (begun === undefined) return
  moved.delete(Number(energy))
  sides.push(Number(side))
  // The pixels are on the screen after the next frame; a message of that frame arrives after it.
  requestAnimationFrame(() => {
    const {port1, port2} = new MessageChannel()
    port1.onmessage = () => delays.push(performance.now() - begun)
    port2.postMessage(null)
  })
})

/** Observe the first canvas over the pictures. */
function observe() {
  const canvas = findAll(document, "canvas[data-energy]")[0]
  if (!canvas || observed.has(canvas)) return
  observed.add(canvas)
  observer.observe(canvas, {attributeFilter: ["data-energy"]})
}

/** @param {Document | ShadowRoot} root @param {string} selector @returns {Element[]} */
function findAll(root, selector) {
  const inside = [...root.querySelectorAll("*")].flatMap(({shadowRoot}) => (shadowRoot ? findAll(shadowRoot, selector) : []))
  return [...root.querySelectorAll(selector), ...inside]
}

const bench = {
  /** The slider of the energy. */
  rail: () => /** @type {HTMLInputElement} */ (findAll(document, 'input[type=range][aria-label^="Energy h"]')[0]),

  /** Wait until the engine shows pixels. */
  async ready() {
    const {energy} = Bokeh.documents[0].get_model_by_name("BrowserEngine").store
    let value = 0.26
    while (observed.size === 0) {
      energy.hold((value += 1e-4))
      for (let k = 0; k < 5; k++) await frame()
      observe()
    }
    energy.cancel()
  },

  /**
   * Drag the slider from one energy to another and back for some seconds, with one move in each frame of the display.
   *
   * @param {HTMLInputElement} rail
   * @param {number} low
   * @param {number} high
   * @param {number} seconds
   */
  async drag(rail, low, high, seconds) {
    for (const values of [delays, sides]) values.length = 0
    moved.clear()
    sent = 0
    const begin = performance.now()
    let frames = 0
    for (let share = 0; share < 1; share = (performance.now() - begin) / (1000 * seconds)) {
      const energy = Number((low + (high - low) * Math.abs(1 - ((share * seconds) % 2))).toFixed(3))
      rail.value = String(energy)
      moved.set(energy, performance.now())
      rail.dispatchEvent(new Event("input"))
      await frame()
      frames++
    }
    return {delays: [...delays], sides: [...sides], frames, sent}
  },

  /**
   * Draw other starts of an ensemble some times, and follow it for some seconds; returns the ms of the former, each with the first
   * picture, and the ms between the frames of the latter.
   *
   * @param {number} repeats
   * @param {number} seconds
   */
  async watch(repeats, seconds) {
    const {data} = findPlayer()
    const starts = []
    for (let seed = 100; seed < 100 + repeats; seed++) {
      const begin = performance.now()
      data.setv({seed}, {sync: false})
      starts.push(performance.now() - begin)
      await frame()
    }
    const play = /** @type {HTMLElement} */ (findAll(document, "button.play[aria-pressed]")[0])
    play.click()
    const frames = []
    const begin = performance.now()
    for (let last = begin; last - begin < 1000 * seconds;) {
      await frame()
      const now = performance.now()
      frames.push(now - last)
      last = now
    }
    play.click()
    return {starts, frames}
  },

  /**
   * Move the cursor over points of the screen; returns the ms that each takes.
   *
   * @param {[number, number][]} points
   */
  async hover(points) {
    const times = []
    for (const [clientX, clientY] of points) {
      const target = deepest(clientX, clientY)
      const begin = performance.now()
      target?.dispatchEvent(
        new PointerEvent("pointermove", {clientX, clientY, bubbles: true, composed: true, pointerType: "mouse"}),
      )
      times.push(performance.now() - begin)
      await frame()
    }
    return times
  },
}

/**
 * The element at a point of the screen, through shadow roots.
 *
 * @param {number} x
 * @param {number} y
 */
function deepest(x, y) {
  let target = document.elementFromPoint(x, y)
  while (target?.shadowRoot?.elementFromPoint(x, y) && target.shadowRoot.elementFromPoint(x, y) !== target) {
    target = target.shadowRoot.elementFromPoint(x, y)
  }
  return target
}

void bench
