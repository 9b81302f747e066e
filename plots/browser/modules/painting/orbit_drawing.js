// @ts-check
/** The drawing of an orbit in the well, with its outcome in words. */

import {exitLines} from "../engine/curves.js"
import {number} from "../numbers.js"
import {placeIn, strokeLine} from "./canvas.js"

/** Radius of the point that marks the start, in pixels. */
const START_RADIUS = 3.5
/** Space around the text, in pixels. */
const PADDING = 6
/** Height of the line of text, in pixels. */
const TEXT_HEIGHT = 22

/**
 * What the lines of a well depend on.
 *
 * @typedef {object} Well
 * @property {import("../engine/starts.js").Window} window
 * @property {number} energy  in units of the page
 * @property {{xs: number[], ys: number[]}[]} limit  limiting curve of the energy
 * @property {string[]} colours  of the outcomes, exits first
 * @property {string} ink  colour of lines and text
 */

/**
 * Draw the limiting curve and the exits of a well.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {{width: number, height: number}} box
 * @param {import("../engine/integrator.js").Integrator} integrator
 * @param {Well} well
 */
export function drawWell(context, box, integrator, {window, energy, limit, colours, ink}) {
  for (const line of limit) strokeLine(context, window, box, line, ink, 1.5)
  for (const exit of exitLines(integrator, energy)) strokeLine(context, window, box, exit, colours[exit.channel - 1], 3)
}

/**
 * Draw an orbit in a well, with a point at its start; return the place of the start in the box.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {{width: number, height: number}} box
 * @param {Well} well
 * @param {Pick<import("../engine/path.js").Path, "x" | "y" | "channel">} path
 * @param {{length: number}} units  units of the well, in units of the page
 * @returns {[number, number]}
 */
export function drawOrbit(context, box, {window, colours, ink}, path, units) {
  const {xs, ys} = toPageUnits(path, units)
  strokeLine(context, window, box, {xs, ys}, path.channel > 0 ? colours[path.channel - 1] : ink, 1.5)
  context.fillStyle = ink
  context.beginPath()
  const [left, top] = placeIn(box, window, [xs[0], ys[0]])
  context.arc(left, top, START_RADIUS, 0, 2 * Math.PI)
  context.fill()
  return [left, top]
}

/**
 * Write text in the lower left corner.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {string} text
 * @param {{width: number, height: number}} box
 * @param {string} ink  colour of the text
 * @param {string} paper  colour behind the text
 */
export function writeText(context, text, box, ink, paper) {
  context.font = "12px system-ui, sans-serif"
  context.fillStyle = paper
  context.fillRect(0, box.height - TEXT_HEIGHT, context.measureText(text).width + 2 * PADDING, TEXT_HEIGHT)
  context.fillStyle = ink
  // On a small card the text is compressed.
  context.fillText(text, PADDING, box.height - PADDING, box.width - 2 * PADDING)
}

/**
 * Describe the outcome of an orbit.
 *
 * @param {Pick<import("../engine/path.js").Path, "channel" | "time" | "crossings">} path
 * @param {number} unit  unit of time of the well, in units of the page
 * @param {string[]} labels  of the outcomes, exits first
 */
export function describeOutcome({channel, time, crossings}, unit, labels) {
  const crossingCount = crossings === 1 ? "1 crossing" : `${crossings} crossings`
  const label = labels[channel - 1] ?? "inside until"
  return `${label[0].toUpperCase()}${label.slice(1)} ${channel > 0 ? "at " : ""}t = ${number(time * unit)}, ${crossingCount}`
}

/**
 * Return the points of an orbit in units of the page.
 *
 * @param {Pick<import("../engine/path.js").Path, "x" | "y">} path
 * @param {{length: number}} units  units of the well, in units of the page
 */
export function toPageUnits({x, y}, {length}) {
  const [xs, ys] = [x, y].map(values => values.map(value => value * length))
  return {xs, ys}
}
