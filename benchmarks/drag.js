// @ts-check
/** Measurements in the page, for `benchmarks/drag.py`. */

const source = Bokeh.documents[0].get_model_by_name("maps")
const frame = () => new Promise(requestAnimationFrame)

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

source.connect(source.properties.data.change, () => {
  const {energy, fate, complete} = source.data
  const begun = moved.get(energy[0])
  if (complete[0] || begun === undefined) return
  moved.delete(energy[0])
  sides.push(fate[0].shape[0])
  // Bokeh paints in the next frame; a message of that frame arrives after it.
  requestAnimationFrame(() => {
    const {port1, port2} = new MessageChannel()
    port1.onmessage = () => delays.push(performance.now() - begun)
    port2.postMessage(null)
  })
})

const bench = {
  /** Wait until the engine shows pixels. */
  async ready() {
    const {complete} = source.data
    document.dispatchEvent(new CustomEvent("energydragged", {detail: 0.4}))
    while (source.data.complete === complete) await frame()
    document.dispatchEvent(new CustomEvent("energyreleased"))
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
    for (let share = 0; share < 1; share = (performance.now() - begin) / (1000 * seconds)) {
      const energy = Number((low + (high - low) * Math.abs(1 - ((share * seconds) % 2))).toFixed(3))
      rail.value = String(energy)
      moved.set(energy, performance.now())
      rail.dispatchEvent(new Event("input"))
      await frame()
    }
    return {delays: [...delays], sides: [...sides], sent}
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
