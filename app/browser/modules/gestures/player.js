// @ts-check
/** Animates the energy: raises it in each frame of the display, up to the end of its range. */

/** Duration of the animation of the whole range. */
const SWEEP_MS = 20_000
/** Least number of steps of the range. Each is a power of ten, which keeps the numbers on the page short. */
const STEPS = 1000

export class Player {
  /**
   * @param {(energy: number) => void} show
   * @param {(energy: number) => void} end  takes the last energy
   */
  constructor(show, end) {
    this.#show = show
    this.#end = end
  }

  #show
  #end
  #frame = 0
  #energy = 0

  get playing() {
    return this.#frame !== 0
  }

  /**
   * Start at an energy, or at the beginning of the range if the energy is at its end. During an animation this has no effect.
   *
   * @param {number} energy
   * @param {number} low
   * @param {number} high
   */
  start(energy, low, high) {
    if (this.playing) return
    this.#energy = energy >= low && energy < high ? energy : low
    const decimals = Math.max(Math.ceil(Math.log10(STEPS / (high - low))), 0)
    let [exact, last] = [this.#energy, performance.now()]
    const tick = (/** @type {number} */ now) => {
      exact = Math.min(exact + ((high - low) * Math.max(now - last, 0)) / SWEEP_MS, high)
      last = now
      this.#energy = Math.min(Number(exact.toFixed(Math.min(decimals, 20))), high)
      this.#show(this.#energy)
      if (exact >= high) this.stop()
      else this.#frame = requestAnimationFrame(tick)
    }
    this.#frame = requestAnimationFrame(tick)
  }

  stop() {
    if (!this.playing) return
    cancelAnimationFrame(this.#frame)
    this.#frame = 0
    this.#end(this.#energy)
  }
}
