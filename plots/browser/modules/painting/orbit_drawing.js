// @ts-check
/** The drawing of an orbit in the well, with its outcome in words. */

import {exitLines} from "../engine/curves.js"
import {number} from "../numbers.js"
import {strokeLine} from "./canvas.js"

/** Radius of the point that marks the start, in pixels. */
const START_RADIUS = 3.5
/** Space around the text, in pixels. */
const PADDING = 6
/** Height of the line of text, in pixels. */
const TEXT_HEIGHT = 22

/**
 * What is drawn.
 *
 * @typedef {object} Drawing
 * @property {import("../engine/starts.js").Window} window  of the well
 * @property {{xs: number[], ys: number[]}[]} limit  limiting curve of the energy
 * @property {import("../engine/path.js").Path} path
 * @property {string[]} colours  of the outcomes, exits first
 * @property {string[]} labels  of the outcomes
 * @property {string} ink  colour of lines and text
 * @property {string} paper  colour behind the text
 */

/**
 * Draw an orbit in the well, with the limiting curve and the exits, and its outcome as text. Return this text.
 *
 * @param {CanvasRenderingContext2D} context  of an empty canvas
 * @param {{width: number, height: number}} box
 * @param {import("../engine/integrator.js").Integrator} integrator
 * @param {Drawing} drawing
 */
export function drawOrbit(context, box, integrator, {window, limit, path, colours, labels, ink, paper}) {
  const {system} = integrator
  const energy = path.energy * system.units.energy
  const draw = strokeLine.bind(null, context, window, box)
  for (const line of limit) draw(line, ink, 1.5)
  for (const {channel, xs, ys} of exitLines(integrator, energy)) draw({xs, ys}, colours[channel - 1], 3)
  const {xs, ys} = toPageUnits(path, system.units)
  draw({xs, ys}, path.channel > 0 ? colours[path.channel - 1] : ink, 1)
  context.fillStyle = ink
  context.beginPath()
  const scale = box.width / (window.xHigh - window.xLow)
  context.arc((xs[0] - window.xLow) * scale, (window.ordinateHigh - ys[0]) * scale, START_RADIUS, 0, 2 * Math.PI)
  context.fill()
  const text = describeOutcome(path, system.units.time, labels)
  writeText(context, text, box, ink, paper)
  return text
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
function writeText(context, text, box, ink, paper) {
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
