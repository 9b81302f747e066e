// @ts-check
/** Places, exits and passages of an ensemble at rising times, and its outcomes; or the starts that a request draws. */

import {Ensemble, Outcomes} from "../../../plots/browser/modules/engine/ensemble.js"
import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {drawStarts} from "../../../plots/browser/modules/engine/random_starts.js"
import {input, modules} from "./read_input.js"

const {system, requests, scene, energy, states, times} = input
const integrator = new Integrator(system, modules)
const draw = (/** @type {any} */ request) => [...drawStarts(request, scene, integrator)]

function follow() {
  const starts = Float64Array.from(states)
  const ensemble = new Ensemble(integrator, energy, starts)
  const frames = times.map((/** @type {number} */ time) => {
    ensemble.advance(time)
    const {x, y, channel} = ensemble
    return {
      x: [...x],
      y: [...y],
      channel: [...channel],
      section: [0, 1, 2, 3].map(column => [...ensemble.atSection(column)]),
      growth: ensemble.growth(),
    }
  })
  const outcomes = new Outcomes(system, modules, energy, starts, times.at(-1))
  while (!outcomes.complete) outcomes.continue()
  ensemble.advance(times[0])
  return {frames, escapeTime: [...ensemble.escapeTime], outcomes: [...outcomes.channel], again: [...ensemble.x]}
}

console.log(JSON.stringify(requests ? requests.map(draw) : follow()))
