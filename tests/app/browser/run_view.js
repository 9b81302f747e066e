// @ts-check
/** The pixels of views, computed as the page does it, in one part and with mirror images. */

import {Picture} from "../../../app/browser/modules/frames.js"
import {Integrator} from "../../../app/browser/modules/integrator.js"
import {Interior} from "../../../app/browser/modules/interior.js"
import {computePixels} from "../../../app/browser/modules/pixels.js"
import {makePotential} from "../../../app/browser/modules/potential.js"
import {input, module} from "./read_input.js"

const {system, views} = input
const potential = makePotential(system.formula)
const [integrator, interior] = [new Integrator(system, module), new Interior(potential)]
const pictures = views.map((/** @type {import("../../../app/browser/modules/pixels.js").View} */ view) => {
  const picture = new Picture(system, view)
  for (const part of picture.deal(3)) picture.add(part, computePixels(integrator, interior, potential, view, part))
  const {fate, time, crossings} = picture.finish()
  return {fate: [...fate], time: [...time], crossings: [...crossings]}
})
console.log(JSON.stringify(pictures))
