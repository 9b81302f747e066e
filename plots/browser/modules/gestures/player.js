// @ts-check
/** The animation of the energy, which rises with each frame of the display up to the end of the range. */

/** Duration of the animation of the whole range, in ms. */
const SWEEP_MS = 20_000
/** Smallest number of steps of the range. The step is a power of ten, so that the energies have few digits. */
const LEAST_STEPS = 1000
/** Largest number of decimals of an energy. */
const MOST_DECIMALS = 20

export class EnergyPlayer {
  /**
   * @param {(energy: number) => void} show  shows each energy
   * @param {(energy: number) => void} end  called with the last energy
   */
  constructor(show, end) {
    this.#show = show
    this.#end = end
  }

  #show
  #end
  #frame = 0
  #energy = 0

  /** Whether an animation is running. */
  get playing() {
    return this.#frame !== 0
  }

  /**
   * Start at an energy, or at the low end of the range if the energy is at the high end or outside.
   * During an animation, this has no effect.
   *
   * @param {number} energy
   * @param {number} low
   * @param {number} high
   */
  start(energy, low, high) {
    if (this.playing) return
    this.#energy = energy >= low && energy < high ? energy : low
    const neededDecimals = Math.ceil(Math.log10(LEAST_STEPS / (high - low)))
    const decimals = Math.min(Math.max(neededDecimals, 0), MOST_DECIMALS)
    let exactEnergy = this.#energy
    let lastTime = performance.now()
    const tick = (/** @type {number} */ now) => {
      exactEnergy = Math.min(exactEnergy + ((high - low) * Math.max(now - lastTime, 0)) / SWEEP_MS, high)
      lastTime = now
      this.#energy = Math.min(Number(exactEnergy.toFixed(decimals)), high)
      this.#show(this.#energy)
      if (exactEnergy >= high) this.stop()
      else this.#frame = requestAnimationFrame(tick)
    }
    this.#frame = requestAnimationFrame(tick)
  }

  /** Stop at the present energy. */
  stop() {
    if (!this.playing) return
    cancelAnimationFrame(this.#frame)
    this.#frame = 0
    this.#end(this.#energy)
  }
}
