// @ts-check
/** A worker: computes the pixels of parts of views, one after the other. */

import {Integrator} from "./integrator.js"
import {Interior} from "./interior.js"
import {computePixels} from "./pixels.js"
import {makePotential} from "./potential.js"

/**
 * @typedef {{system: import("./system.js").System, module: WebAssembly.Module}} SystemMessage
 * @typedef {{view: import("./pixels.js").View, part: import("./pixels.js").Part}} PartMessage
 */

/** @type {(view: import("./pixels.js").View, part: import("./pixels.js").Part) => import("./pixels.js").Pixels} */
let compute

/** @param {MessageEvent<SystemMessage | PartMessage>} event */
onmessage = ({data}) => {
  if ("system" in data) {
    const potential = makePotential(data.system.formula)
    const [integrator, interior] = [new Integrator(data.system, data.module), new Interior(potential)]
    compute = (view, part) => computePixels(integrator, interior, potential, view, part)
    return
  }
  const pixels = compute(data.view, data.part)
  postMessage(pixels, {transfer: [pixels.fate.buffer, pixels.time.buffer, pixels.crossings.buffer]})
}
