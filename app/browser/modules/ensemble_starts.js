// @ts-check
/** Random starts of an ensemble; equal seeds give equal starts. */

import {drawEntrances, drawTubes} from "./exit_starts.js"
import {Exits} from "./exits.js"
import {OutsideTest} from "./interior.js"
import {energyUnit, space, Starts} from "./slice.js"
import {windowAt} from "./system.js"

/**
 * Where the starts are: "well", evenly on the energy surface; "view" and "box", evenly on the slice in a window; "disc", evenly on it
 * around a point; "exits", on the exits and going inward; "tubes", at the edge of the tubes that lead out.
 *
 * @typedef {object} Request
 * @property {"well" | "view" | "box" | "disc" | "exits" | "tubes"} where
 * @property {number} count
 * @property {number} seed
 * @property {[number, number]} point  middle of the disc, in units of the page
 * @property {[number, number, number, number]} box  xLow, xHigh, ordinateLow, ordinateHigh, in units of the page
 * @property {number} radius  of the disc, as a share of half the window
 */

/** Draws for each start, at most; of a window without an interior there are no starts. */
const MOST_DRAWS = 200

/**
 * The states x, y, px, py of the starts inside all exits, in units of the well.
 *
 * @param {Request} request
 * @param {import("./frames.js").Scene} scene  slice, energy and window
 * @param {import("./integrator.js").Integrator} integrator
 * @returns {Float64Array}
 */
export const drawStarts = (request, scene, integrator) => integrator.temporarily(() => draw(request, scene, integrator))

/** @type {(request: Request, scene: import("./frames.js").Scene, integrator: import("./integrator.js").Integrator) => Float64Array} */
function draw(request, scene, integrator) {
  const {system} = integrator
  const energy = scene.energy / energyUnit(system.units)
  const exits = new Exits(integrator, [energy])
  const random = randomNumbers(request.seed)
  if (request.where === "exits") return drawEntrances(request.count, integrator, exits, energy, random)
  if (request.where === "tubes") return drawTubes(request.count, integrator, exits, energy, random)
  const isWell = request.where === "well"
  const slice = isWell ? space(system.units) : scene.slice
  const window = isWell ? windowAt(system.windows.x_y, scene.energy) : request.where === "box" ? boxOf(request) : scene.window
  if (!window) return new Float64Array(0)
  const [starts, test] = [new Starts(slice, integrator, energy), new OutsideTest(integrator, exits, 1)]
  const {found} = starts
  const place = request.where === "disc" ? inDisc(request, window, random) : inWindow(window, random)
  const states = new Float64Array(4 * request.count)
  let count = 0
  for (let draw = 0; draw < MOST_DRAWS * request.count && count < request.count; draw++) {
    const [abscissa, ordinate] = place()
    if (!starts.find(abscissa / slice.units[0], ordinate / slice.units[1])) continue
    if (test.find([found.x, found.y, 0, 0], [energy])[0] > 0) continue
    if (isWell) turn(found, 2 * Math.PI * random())
    states.set([found.x, found.y, found.px, found.py], 4 * count++)
  }
  return states.slice(0, 4 * count)
}

/**
 * @param {Request} request
 * @returns {import("./slice.js").Window}
 */
function boxOf({box: [xLow, xHigh, ordinateLow, ordinateHigh]}) {
  return {xLow, xHigh, ordinateLow, ordinateHigh}
}

/**
 * Turn the velocity of a start: at each place all directions are equally likely on the energy surface.
 *
 * @param {{px: number, py: number}} start
 * @param {number} angle
 */
function turn(start, angle) {
  const speed = Math.hypot(start.px, start.py)
  start.px = speed * Math.cos(angle)
  start.py = speed * Math.sin(angle)
}

/** @type {(window: import("./slice.js").Window, random: () => number) => () => [number, number]} */
const inWindow =
  ({xLow, xHigh, ordinateLow, ordinateHigh}, random) =>
  () => [xLow + random() * (xHigh - xLow), ordinateLow + random() * (ordinateHigh - ordinateLow)]

/** @type {(request: Request, window: import("./slice.js").Window, random: () => number) => () => [number, number]} */
const inDisc =
  ({point, radius}, {xLow, xHigh, ordinateLow, ordinateHigh}, random) =>
  () => {
    const [distance, angle] = [radius * Math.sqrt(random()), 2 * Math.PI * random()]
    return [
      point[0] + 0.5 * (xHigh - xLow) * distance * Math.cos(angle),
      point[1] + 0.5 * (ordinateHigh - ordinateLow) * distance * Math.sin(angle),
    ]
  }

/**
 * Random numbers from 0 to 1 (the generator mulberry32).
 *
 * @param {number} seed  an integer
 * @returns {() => number}
 */
export function randomNumbers(seed) {
  let state = seed | 0
  return () => {
    state = (state + 0x6d2b79f5) | 0
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state)
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32
  }
}
