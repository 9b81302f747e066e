// @ts-check
/** Random starts at the exits: orbits that enter through them, and orbits at the edge of the tubes that lead out. */

import {Ensemble} from "./ensemble.js"
import {exitPoint} from "./exits.js"
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
 * @typedef {{curve: import("./exits.js").ExitCurve, s: number, flux: number}} Part
 */

/**
 * States on the exits over saddles that move into the well, distributed as the flux, as by `sample_entrances` of the library.
 *
 * @param {number} count
 * @param {import("./exits.js").ExitCurve[]} exits  at the energy
 * @param {import("./potential.js").Potential} potential
 * @param {number} energy
 * @param {() => number} random
 */
export function drawEntrances(count, exits, potential, energy, random) {
  const draw = drawPlaces(exits, potential, energy, random)
  return collect(count, () => {
    const place = draw()
    const share = 2 * random() - 1
    return place && launch(place, SHIFT, share, potential, energy)
  })
}

/**
 * States at the edge of the tubes of orbits that approach the Lyapunov orbits, some time before they come near: half of them inside,
 * which pass the exit, and half outside, which turn back. They are the ends of orbits that go into the well backward in time. The
 * lines in a frame that rotates are no Lyapunov orbits, and have none.
 *
 * @param {number} count
 * @param {import("./exits.js").ExitCurve[]} exits
 * @param {import("./potential.js").Potential} potential
 * @param {import("./integrator.js").Integrator} integrator
 * @param {number} energy
 * @param {() => number} random
 */
export function drawTubes(count, exits, potential, integrator, energy, random) {
  const curves = exits.filter(({returns}) => !returns)
  const draw = drawPlaces(curves, potential, energy, random)
  const states = collect(count, () => {
    const place = draw()
    const along = random() < 0.5 ? 1 : -1
    const [shift, inward] = random() < 0.5 ? [SHIFT, FROM_EDGE] : [FROM_EDGE, 0]
    return place && launch(place, shift, along * Math.sqrt(1 - inward * inward), potential, energy)
  })
  const ensemble = new Ensemble(new Integrator(reversedInTime(integrator.system), integrator.module), energy, states)
  ensemble.advance(BEFORE)
  return reverse(ensemble)
}

/**
 * The states of the orbits that are still inside, with reversed momenta.
 *
 * @param {Ensemble} ensemble
 */
function reverse(ensemble) {
  const [found, {px, py}] = [/** @type {number[]} */ ([]), ensemble.momenta()]
  for (let i = 0; i < ensemble.count; i++) {
    if (ensemble.channel[i] === 0) found.push(ensemble.x[i], ensemble.y[i], -px[i], -py[i])
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

/**
 * A function that draws places on the exits over saddles, as often as the flux through them; null if all are closed.
 *
 * @param {import("./exits.js").ExitCurve[]} exits
 * @param {import("./potential.js").Potential} potential
 * @param {number} energy
 * @param {() => number} random
 */
function drawPlaces(exits, potential, energy, random) {
  /** @type {Part[]} */
  const parts = []
  let flux = 0
  for (const curve of exits.filter(({open, side}) => open && side === 0)) {
    for (let k = 0; k < PARTS; k++) {
      const s = -1 + (2 * k + 1) / PARTS
      const [x, y] = exitPoint(curve, s)
      flux += speed(potential, energy, x, y) * Math.hypot(...tangent(curve, s))
      parts.push({curve, s, flux})
    }
  }
  return () => {
    const target = flux * random()
    const part = parts.find(each => each.flux > target)
    return part ? {curve: part.curve, s: part.s + (2 * random() - 1) / PARTS} : null
  }
}

/**
 * The state at a place of an exit, shifted inward, whose velocity has a share along the exit; the rest is inward.
 *
 * @param {{curve: import("./exits.js").ExitCurve, s: number}} place
 * @param {number} shift
 * @param {number} share
 * @param {import("./potential.js").Potential} potential
 * @param {number} energy
 */
function launch({curve, s}, shift, share, potential, energy) {
  const [tx, ty] = tangent(curve, s)
  const length = Math.hypot(tx, ty)
  const along = [tx / length, ty / length]
  const side = along[1] * curve.outward[0] - along[0] * curve.outward[1] > 0 ? -1 : 1
  const inward = [side * along[1], -side * along[0]]
  const rest = Math.sqrt(Math.max(1 - share * share, 0))
  const [x, y] = exitPoint(curve, s).map((value, axis) => value + shift * curve.halfWidth * inward[axis])
  const p = speed(potential, energy, x, y)
  return [x, y, p * (share * along[0] + rest * inward[0]), p * (share * along[1] + rest * inward[1])]
}

/** @type {(potential: import("./potential.js").Potential, energy: number, x: number, y: number) => number} */
const speed = (potential, energy, x, y) => Math.sqrt(Math.max(2 * (energy - potential.value(x, y)), 0))

/**
 * Derivative of the point of an exit with respect to s.
 *
 * @param {import("./exits.js").ExitCurve} curve
 * @param {number} s
 */
function tangent(curve, s) {
  const half = 0.5 / PARTS
  const [before, after] = [exitPoint(curve, s - half), exitPoint(curve, s + half)]
  return [(after[0] - before[0]) / (2 * half), (after[1] - before[1]) / (2 * half)]
}
