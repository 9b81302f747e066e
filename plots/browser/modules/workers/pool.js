// @ts-check
/**
 * Workers that compute a picture in parts. Each worker has one part at a time. The other parts wait here until a worker is free
 * or another picture replaces them.
 *
 * @typedef {import("../engine/pixels.js").View} View
 * @typedef {import("../engine/pixels.js").Part} Part
 * @typedef {import("../engine/pixels.js").Pixels} Pixels
 *
 * @typedef {object} Task  a picture to compute
 * @property {View} view
 * @property {Part[]} waiting  parts that no worker has begun
 * @property {(part: Part, pixels: Pixels) => void} receive
 */

/** Largest number of workers. */
const MOST_WORKERS = 8

/** Return the number of workers: one for each core, because the page waits while they compute a picture. */
export const workerCount = () => Math.min(navigator.hardwareConcurrency, MOST_WORKERS)

export class Pool {
  /** @param {() => Worker} start  starts and returns a worker */
  constructor(start) {
    this.#start = start
  }

  #start
  /** @type {Worker[]} */
  #workers = []
  /** @type {Set<Worker>} */
  #idle = new Set()
  /** @type {Task | null} */
  #task = null

  /**
   * Send a system to all workers, which the first call starts.
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
    this.#task = {view, waiting: [...parts], receive}
    for (const worker of [...this.#idle]) this.#giveNext(worker)
  }

  /** Drop the present picture. Workers finish their parts, whose pixels are ignored. */
  cancel() {
    this.#task = null
  }

  /** Give a worker the next part, if any. @param {Worker} worker */
  #giveNext(worker) {
    const task = this.#task
    const part = task?.waiting.shift()
    if (!task || !part) {
      this.#idle.add(worker)
      return
    }
    this.#idle.delete(worker)
    worker.onmessage = ({data}) => {
      if (this.#task === task) task.receive(part, data)
      this.#giveNext(worker)
    }
    worker.postMessage({view: task.view, part})
  }
}
