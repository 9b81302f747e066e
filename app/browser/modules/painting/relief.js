// @ts-check
/** The relief of the well, which the server shades and which does not depend on the energy, on canvases over the picture. */

import {PixelImage} from "../../../../plots/browser/modules/painting/pixel_image.js"
import {wellPicture} from "./pictures.js"

export class Relief {
  /** @param {() => string} well  key of the potential of the view */
  constructor(well) {
    this.#well = well
  }

  #well
  #image = new PixelImage()

  /**
   * Paint the relief in a window that fills the box, unless the picture shows another potential.
   *
   * @param {CanvasRenderingContext2D} context
   * @param {{width: number, height: number}} box
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window} window
   */
  paint(context, box, {xLow, xHigh, ordinateLow, ordinateHigh}) {
    const renderer = rendererOf(wellPicture())
    const data = renderer?.data_source.data
    if (!data?.image[0] || data.well[0] !== this.#well()) return
    const [scaleX, scaleY] = [box.width / (xHigh - xLow), box.height / (ordinateHigh - ordinateLow)]
    context.save()
    context.imageSmoothingEnabled = true
    context.translate((data.x[0] - xLow) * scaleX, (ordinateHigh - data.y[0] - data.dh[0]) * scaleY)
    const size = {width: data.dw[0] * scaleX, height: data.dh[0] * scaleY}
    this.#image.paint(context, size, data.image[0], renderer.glyph.color_mapper)
    context.restore()
  }
}

/** @param {import("./pictures.js").Picture | undefined} picture */
const rendererOf = picture => picture?.view.model.renderers.find((/** @type {any} */ each) => each.data_source.name === "relief")
