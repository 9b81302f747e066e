// @ts-check
/** Ends of orbits as the previews, the card and the player of ensembles find them, in units of the well. */

import {Ensemble} from "../../../plots/browser/modules/engine/ensemble.js"
import {Exits} from "../../../plots/browser/modules/engine/exits.js"
import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {findAllEnds} from "../../../plots/browser/modules/engine/orbits.js"
import {followOrbit} from "../../../plots/browser/modules/engine/path.js"
import {reversedInTime} from "../../../plots/browser/modules/engine/system.js"
import {input, modules} from "./read_input.js"

const {energy, states, horizon, isBackward} = input
const system = isBackward ? reversedInTime(input.system) : input.system
const integrator = new Integrator(system, modules)
const {tolerance} = system.layout
const exits = new Exits(integrator, [energy])

function firstFreeByte() {
  return integrator.temporarily(() => integrator.array("int8", [1]).kernelArguments[0])
}

function preview() {
  const before = firstFreeByte()
  const {fate, time, crossings} = findAllEnds(integrator, states.flat(), exits, {horizon, tolerance})
  return {fate: [...fate], time: [...time], crossings: [...crossings], lostBytes: [firstFreeByte() - before]}
}

function card() {
  const paths = states.map((/** @type {number[]} */ state) =>
    integrator.temporarily(() => followOrbit(integrator, integrator.array("float64", [1, 4], state), exits, energy, horizon)),
  )
  const all = (/** @type {"channel" | "time" | "crossings"} */ name) =>
    paths.map((/** @type {import("../../../plots/browser/modules/engine/path.js").Path} */ path) => path[name])
  return {fate: all("channel"), time: all("time"), crossings: all("crossings")}
}

function player() {
  const ensemble = new Ensemble(integrator, energy, states.flat())
  ensemble.advance(horizon)
  return {fate: [...ensemble.channel], time: [...ensemble.escapeTime], x: [...ensemble.x]}
}

console.log(JSON.stringify({preview: preview(), card: card(), player: player()}))
