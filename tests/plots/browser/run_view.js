// @ts-check
/** The pixels of views, computed as the page does it, in one part and with mirror images. */

import {PixelCollector} from "../../../plots/browser/modules/workers/frames.js"
import {Integrator} from "../../../plots/browser/modules/engine/integrator.js"
import {computePixels} from "../../../plots/browser/modules/engine/pixels.js"
import {input, modules} from "./read_input.js"

const {system, views} = input
const integrator = new Integrator(system, modules)
const pictures = views.map((/** @type {import("../../../plots/browser/modules/engine/pixels.js").View} */ view) => {
  const picture = new PixelCollector(system, view)
  for (const part of picture.divide(3)) picture.add(part, computePixels(integrator, view, part))
  const {fate, time, crossings} = picture.finish()
  return {fate: [...fate], time: [...time], crossings: [...crossings]}
})
console.log(JSON.stringify(pictures))
