// @ts-check
/** The program of a worker, which computes the pixels of parts of views. */

import {Integrator} from "../engine/integrator.js"
import {computePixels} from "../engine/pixels.js"

/**
 * @typedef {{system: import("../engine/system.js").System, modules: import("../engine/integrator.js").Modules}} SystemMessage
 * @typedef {{view: import("../engine/pixels.js").View, part: import("../engine/pixels.js").Part}} PartMessage
 */

/** @type {(view: import("../engine/pixels.js").View, part: import("../engine/pixels.js").Part) => import("../engine/pixels.js").Pixels} */
let compute

/** @param {MessageEvent<SystemMessage | PartMessage>} event */
onmessage = ({data}) => {
  if ("system" in data) {
    const integrator = new Integrator(data.system, data.modules)
    compute = (view, part) => computePixels(integrator, view, part)
    return
  }
  const pixels = compute(data.view, data.part)
  postMessage(pixels, {transfer: [pixels.fate.buffer, pixels.time.buffer, pixels.crossings.buffer]})
}
