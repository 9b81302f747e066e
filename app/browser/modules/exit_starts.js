// @ts-check
/** Random starts at the exits: orbits that enter through them, and orbits at the edge of the tubes that lead out. */

import {Ensemble} from "./ensemble.js"
import {Integrator} from "./integrator.js"
import {reversedInTime} from "./system.js"

/** Parts of an exit, each with the flux through it. */
const PARTS = 200
/** Distance of orbits that enter from the exit, as a share of its half width: on it, rounding would decide what is inside. */
const SHIFT = 1e-7
/** Distance of the orbits at a tube from its edge, where they pass the exit, as a share of half its width. */
const FROM_EDGE = 3e-3
/** How long before they come to the exit the orbits at a tube start, in units of the well. */
const BEFORE = 9

/**
 * A part of an exit: its middle s, and the flux through this and all parts before it.
 *
 * @typedef {{exit: import("./exits.js").Exit, s: number, flux: number}} Part
 *
 * @typedef {{exit: import("./exits.js").Exit, s: number}} Place
 */

/**
 * States on the exits over saddles that move into the well, distributed as the flux, as by `sample_entrances` of the library.
 *
 * @param {number} count
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./exits.js").Exits} exits  at the energy
 * @param {number} energy
 * @param {() => number} random
 */
export function drawEntrances(count, integrator, exits, energy, random) {
  const source = new Openings(integrator, exits, exits.list(), energy, random)
  return collect(count, () => {
    const place = source.draw()
    const share = 2 * random() - 1
    return place && source.launch(place, SHIFT, share)
  })
}

/**
 * States at the edge of the tubes of orbits that approach the Lyapunov orbits, some time before they come near: half of them inside,
 * which pass the exit, and half outside, which turn back. They are the ends of orbits that go into the well backward in time. The
 * lines in a frame that rotates are no Lyapunov orbits, and have none.
 *
 * @param {number} count
 * @param {import("./integrator.js").Integrator} integrator
 * @param {import("./exits.js").Exits} exits
 * @param {number} energy
 * @param {() => number} random
 */
export function drawTubes(count, integrator, exits, energy, random) {
  const orbits = exits.list().filter(({returns}) => !returns)
  const source = new Openings(integrator, exits, orbits, energy, random)
  const states = collect(count, () => {
    const place = source.draw()
    const along = random() < 0.5 ? 1 : -1
    const [shift, inward] = random() < 0.5 ? [SHIFT, FROM_EDGE] : [FROM_EDGE, 0]
    return place && source.launch(place, shift, along * Math.sqrt(1 - inward * inward))
  })
  const ensemble = new Ensemble(new Integrator(reversedInTime(integrator.system), integrator.modules), energy, states)
  ensemble.advance(BEFORE)
  return reverse(ensemble)
}

/**
 * The states of the orbits that are still inside, with reversed momenta.
 *
 * @param {Ensemble} ensemble
 */
function reverse(ensemble) {
  const [found, {x, y, channel}, {px, py}] = [/** @type {number[]} */ ([]), ensemble, ensemble.momenta()]
  for (let i = 0; i < ensemble.count; i++) {
    if (channel[i] === 0) found.push(x[i], y[i], -px[i], -py[i])
  }
  return Float64Array.from(found)
}

/**
 * @param {number} count
 * @param {() => number[] | null} draw
 */
function collect(count, draw) {
  const states = new Float64Array(4 * count)
  for (let k = 0; k < count; k++) {
    const state = draw()
    if (!state) return new Float64Array(0)
    states.set(state, 4 * k)
  }
  return states
}

/** The open exits over saddles among some. */
class Openings {
  /**
   * @param {import("./integrator.js").Integrator} integrator
   * @param {import("./exits.js").Exits} exits  at the energy
   * @param {import("./exits.js").Exit[]} some
   * @param {number} energy
   * @param {() => number} random
   */
  constructor(integrator, exits, some, energy, random) {
    this.#exits = exits
    this.#random = random
    this.#speed = (/** @type {number} */ x, /** @type {number} */ y) =>
      Math.sqrt(Math.max(2 * (energy - integrator.value(x, y)), 0))
    for (const exit of some.filter(({isOpen, isCircle}) => isOpen && !isCircle)) {
      for (let k = 0; k < PARTS; k++) {
        const s = -1 + (2 * k + 1) / PARTS
        const {point, along} = this.#look({exit, s})
        this.#flux += this.#speed(...point) * Math.hypot(...along)
        this.#parts.push({exit, s, flux: this.#flux})
      }
    }
  }

  #exits
  #random
  #speed
  #flux = 0
  /** @type {Part[]} */
  #parts = []

  /** A place, drawn as often as the flux through it; null if all exits are closed. */
  draw() {
    const target = this.#flux * this.#random()
    const part = this.#parts.find(each => each.flux > target)
    return part ? {exit: part.exit, s: part.s + (2 * this.#random() - 1) / PARTS} : null
  }

  /**
   * The state at a place, shifted inward, whose velocity has a share along the exit; the rest is inward.
   *
   * @param {Place} place
   * @param {number} shift
   * @param {number} share
   */
  launch(place, shift, share) {
    const {outward, halfWidth} = place.exit
    const {point, along: tangent} = this.#look(place)
    const length = Math.hypot(...tangent)
    const along = tangent.map(component => component / length)
    const side = along[1] * outward[0] - along[0] * outward[1] > 0 ? -1 : 1
    const inward = [side * along[1], -side * along[0]]
    const rest = Math.sqrt(Math.max(1 - share * share, 0))
    const [x, y] = point.map((value, axis) => value + shift * halfWidth * inward[axis])
    const p = this.#speed(x, y)
    return [x, y, p * (share * along[0] + rest * inward[0]), p * (share * along[1] + rest * inward[1])]
  }

  /**
   * The point at a place, and its derivative with respect to s.
   *
   * @param {Place} place
   * @returns {{point: [number, number], along: [number, number]}}
   */
  #look({exit, s}) {
    const half = 0.5 / PARTS
    const [xs, ys] = this.#exits.points(exit, [s - half, s, s + half])
    return {point: [xs[1], ys[1]], along: [(xs[2] - xs[0]) / (2 * half), (ys[2] - ys[0]) / (2 * half)]}
  }
}
