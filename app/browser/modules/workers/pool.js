// @ts-check
/**
 * Workers that compute a picture in parts. Each worker has one part at a time. The other parts wait here until a worker is free
 * or another picture replaces them.
 *
 * @typedef {import("../engine/pixels.js").View} View
 * @typedef {import("../engine/pixels.js").Part} Part
 * @typedef {import("../engine/pixels.js").Pixels} Pixels
 *
 * @typedef {object} Picture
 * @property {View} view
 * @property {Part[]} waiting
 * @property {(part: Part, pixels: Pixels) => void} receive
 */

/** Largest number of workers. */
const MOST_WORKERS = 8

/** Return the number of workers, which leaves one core to the page. */
export const workerCount = () => Math.min(Math.max(navigator.hardwareConcurrency - 1, 1), MOST_WORKERS)

export class Pool {
  /** @param {() => Worker} start  starts a worker */
  constructor(start) {
    this.#start = start
  }

  #start
  /** @type {Worker[]} */
  #workers = []
  /** @type {Set<Worker>} */
  #idle = new Set()
  /** @type {Picture | null} */
  #picture = null

  /**
   * Give a system to all workers, which the first call starts.
   *
   * @param {import("../engine/system.js").System} system
   * @param {import("../engine/integrator.js").Modules} modules
   */
  setSystem(system, modules) {
    this.cancel()
    if (this.#workers.length === 0) {
      this.#workers = Array.from({length: workerCount()}, this.#start)
      this.#idle = new Set(this.#workers)
    }
    for (const worker of this.#workers) worker.postMessage({system, modules})
  }

  /**
   * Compute the parts of a picture instead of the waiting parts of the present picture.
   *
   * @param {View} view
   * @param {Part[]} parts
   * @param {(part: Part, pixels: Pixels) => void} receive
   */
  compute(view, parts, receive) {
    this.#picture = {view, waiting: [...parts], receive}
    for (const worker of [...this.#idle]) this.#next(worker)
  }

  /** Drop the present picture. */
  cancel() {
    this.#picture = null
  }

  /** @param {Worker} worker */
  #next(worker) {
    const picture = this.#picture
    const part = picture?.waiting.shift()
    if (!picture || !part) {
      this.#idle.add(worker)
      return
    }
    this.#idle.delete(worker)
    worker.onmessage = ({data}) => {
      if (this.#picture === picture) picture.receive(part, data)
      this.#next(worker)
    }
    worker.postMessage({view: picture.view, part})
  }
}
