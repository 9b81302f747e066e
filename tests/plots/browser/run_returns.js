// @ts-check
/** The returns of each orbit of a grid of starts, in the order of time. */

import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {Returns} from "../../../plots/browser/modules/engine/returns.js"
import {input, modules} from "./read_input.js"

const {system, starts} = input
const returns = new Returns(new Integrator(system, modules), starts)
/** @type {Record<number, [number, number][]>} */
const found = {}
/** @type {Record<number, number>} */
const channels = {}
const [column, other] = starts.slice.sectionColumns
while (!returns.complete)
  returns.continue(
    (orbit, state) => (found[orbit] ??= []).push([state[column], state[other]]),
    (orbit, channel) => (channels[orbit] = channel),
  )
console.log(JSON.stringify({found, channels}))
