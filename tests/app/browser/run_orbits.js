// @ts-check
/** Ends of orbits as the previews, the card and the player of ensembles find them, in units of the well. */

import {Ensemble} from "../../../app/browser/modules/ensemble.js"
import {Exits} from "../../../app/browser/modules/exits.js"
import {Integrator} from "../../../app/browser/modules/integrator.js"
import {propagate} from "../../../app/browser/modules/propagate.js"
import {reversedInTime} from "../../../app/browser/modules/system.js"
import {traceOrbit} from "../../../app/browser/modules/trace.js"
import {input, modules} from "./read_input.js"

const {energy, states, horizon, isBackward} = input
const system = isBackward ? reversedInTime(input.system) : input.system
const integrator = new Integrator(system, modules)
const {layout} = system

function firstFreeByte() {
  return integrator.temporarily(() => integrator.array("int8", [1]).passed[0])
}

function preview() {
  const exits = new Exits(integrator, [energy])
  const before = firstFreeByte()
  const ends = propagate(integrator, Float64Array.from(states.flat()), exits, [], horizon, layout.tolerance)
  const {fate, time, crossings} = ends
  return {fate: [...fate], time: [...time], crossings: [...crossings], lostBytes: [firstFreeByte() - before]}
}

function card() {
  const traces = states.map((/** @type {number[]} */ [x, y, px, py]) =>
    traceOrbit(integrator, {x, y, px, py, h: energy}, horizon),
  )
  const all = (/** @type {"channel" | "time" | "crossings"} */ name) =>
    traces.map((/** @type {import("../../../app/browser/modules/trace.js").Trace} */ trace) => trace[name])
  return {fate: all("channel"), time: all("time"), crossings: all("crossings")}
}

function player() {
  const ensemble = new Ensemble(integrator, energy, Float64Array.from(states.flat()))
  ensemble.advance(horizon)
  return {fate: [...ensemble.channel], time: [...ensemble.escapeTime], x: [...ensemble.x]}
}

console.log(JSON.stringify({preview: preview(), card: card(), player: player()}))
