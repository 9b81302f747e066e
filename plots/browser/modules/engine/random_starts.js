// @ts-check
/** Random starts of an ensemble. Equal seeds give equal starts. */

import {Ensemble} from "./ensemble.js"
import {Exits} from "./exits.js"
import {Integrator} from "./integrator.js"
import {findStarts, keepInside, placeWindow, windowAt} from "./starts.js"
import {reversedInTime} from "./system.js"

/**
 * The starts to draw: "well", uniformly on the energy surface; "view" and "box", uniformly on the slice in a window;
 * "disc", uniformly on the slice around a point; "exits", on the exits, moving inward; "tubes", at the edge of the tubes of
 * orbits that lead out.
 *
 * @typedef {object} StartRequest
 * @property {"well" | "view" | "box" | "disc" | "exits" | "tubes"} where
 * @property {number} count
 * @property {number} seed
 * @property {[number, number]} point  middle of the disc, in units of the page
 * @property {[number, number, number, number]} box  xLow, xHigh, ordinateLow, ordinateHigh, in units of the page
 * @property {number} radius  of the disc, as a share of half the width and of half the height of the window
 */

/** Largest number of draws for each start. In a window without an interior, no draw gives a start. */
const MOST_DRAWS = 200

/**
 * Return the states x, y, px, py of the starts inside all exits, in units of the well.
 *
 * @param {StartRequest} request
 * @param {import("../workers/frames.js").Scene} scene  slice, energy and window
 * @param {Integrator} integrator
 * @returns {Float64Array}
 */
export const drawStarts = (request, scene, integrator) =>
  integrator.temporarily(() => {
    const energy = scene.energy / integrator.system.units.energy
    if (request.where === "exits") return drawAtExits(integrator, request, energy, false)
    if (request.where === "tubes") return followBackward(integrator, energy, drawAtExits(integrator, request, energy, true))
    return drawOnSlice(integrator, request, scene, energy)
  })

/**
 * Draw states on the exits, moving inward; with `ofTubes`, states near the edges of the tubes.
 *
 * @param {Integrator} integrator
 * @param {StartRequest} request
 * @param {number} energy
 * @param {boolean} ofTubes
 */
function drawAtExits(integrator, {count, seed}, energy, ofTubes) {
  const {address, table} = integrator
  const states = integrator.array("float64", [count, 4])
  const curves = new Exits(integrator, [energy]).curves.at(0)
  const inputs = [curves, energy, Number(ofTubes), integrator.integers([seed]), states]
  const drawnCount = integrator.call("draw_at_exits", address.potential_value, table, ...inputs)
  return Float64Array.from(states.first(drawnCount).values)
}

/**
 * Return states whose orbits lead to the given states, by following the orbits backward in time into the well.
 *
 * @param {Integrator} integrator
 * @param {number} energy
 * @param {Float64Array} states
 */
function followBackward({system, modules}, energy, states) {
  const ensemble = new Ensemble(new Integrator(reversedInTime(system), modules), energy, states)
  ensemble.advance(system.layout.beforeExit)
  return ensemble.reversedStates()
}

/**
 * Draw points of the slice until enough of them are starts inside.
 *
 * @param {Integrator} integrator
 * @param {StartRequest} request
 * @param {import("../workers/frames.js").Scene} scene
 * @param {number} energy
 */
function drawOnSlice(integrator, request, scene, energy) {
  const {count, where} = request
  const slice = where === "well" ? integrator.system.surface : scene.slice
  const window = windowOf(integrator, request, scene)
  const states = new Float64Array(4 * count)
  if (!window) return states.subarray(0, 0)
  const exits = new Exits(integrator, [energy])
  const [area, seed] = [placeWindow(integrator, window, slice.units), integrator.integers([request.seed])]
  // Numbers of `states` that are set.
  let filled = 0
  for (let draw = 0; draw < MOST_DRAWS && filled < states.length; draw++) {
    integrator.temporarily(() => {
      const points = integrator.array("float64", [slice.motion.length - 1, count])
      integrator.call("scatter_points", seed, area, Number(where === "disc"), points)
      const [rows, fate] = [integrator.array("int64", [count]), integrator.array("int8", [count])]
      const inside = keepInside(integrator, findStarts(integrator, slice, energy, points), exits, rows, fate)
      const newStates = inside.states.values.subarray(0, states.length - filled)
      states.set(newStates, filled)
      filled += newStates.length
    })
  }
  return states.subarray(0, filled)
}

/**
 * Return the rectangle of a request. A disc is the ellipse in this rectangle.
 *
 * @param {Integrator} integrator
 * @param {StartRequest} request
 * @param {import("../workers/frames.js").Scene} scene
 * @returns {import("./starts.js").Window | null}
 */
function windowOf(integrator, {where, box, point: [x, ordinate], radius}, {energy, window}) {
  if (where === "well") return windowAt(integrator, "x_y", energy)
  if (where === "view") return window
  const width = 0.5 * radius * (window.xHigh - window.xLow)
  const height = 0.5 * radius * (window.ordinateHigh - window.ordinateLow)
  const discBox = [x - width, x + width, ordinate - height, ordinate + height]
  const [xLow, xHigh, ordinateLow, ordinateHigh] = where === "box" ? box : discBox
  return {xLow, xHigh, ordinateLow, ordinateHigh}
}
