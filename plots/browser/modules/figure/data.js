// @ts-check
/**
 * The data of a live figure, which `plots/live/live_data.py` writes.
 *
 * @typedef {object} FigureData
 * @property {import("../engine/system.js").System} system
 * @property {string} module  WebAssembly of the system, in base64
 * @property {import("../engine/system.js").Slice} slice
 * @property {string} plane  name of the slice
 * @property {[string, string]} axes  symbols of the axes of the slice
 * @property {number} energy  at first
 * @property {number} low  lowest energy
 * @property {number} high  highest energy
 * @property {number} decimals  of the energies
 * @property {import("../engine/starts.js").Window} window  at first
 * @property {boolean} home  whether this is the default window of the energy
 * @property {[number, number][]} starts  of the chosen orbits
 * @property {number} longest  longest time of orbits, in units of the page
 * @property {number} horizon  longest time of previews, in units of the page
 * @property {string} exact  description of the exact map
 * @property {string[]} colours  of the outcomes, exits first
 * @property {string[]} labels  of the outcomes
 * @property {string[]} orbits  colours of the chosen orbits
 * @property {import("../painting/columns.js").Coding} coding
 * @property {PictureData[]} pictures
 *
 * A picture of the map.
 *
 * @typedef {object} PictureData
 * @property {string} name
 * @property {string} column  of the codes of its pixels
 * @property {string[]} colours  of the codes
 * @property {{colours: string[], low: number, high: number} | null} times  logarithmic scale of the escape times, if they are shown
 * @property {string} image  exact pixels, as a data address
 */

/** Return the bytes of a text in base64. @param {string} text */
export const bytesOf = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0))

/** Bytes of an image with the numbers of rows and columns, in the form of Bokeh. */
export class ByteImage extends Uint8Array {
  /**
   * @param {ArrayBuffer} buffer
   * @param {number[]} shape
   */
  constructor(buffer, shape) {
    super(buffer)
    this.shape = shape
  }
}

/** Numbers of an image with the numbers of rows and columns, in the form of Bokeh. */
export class FloatImage extends Float32Array {
  /**
   * @param {ArrayBuffer} buffer
   * @param {number[]} shape
   */
  constructor(buffer, shape) {
    super(buffer)
    this.shape = shape
  }
}

/** Columns that say which types of images a live figure has. @type {import("../painting/columns.js").Columns} */
export const IMAGE_TYPES = {
  fate: [new ByteImage(new ArrayBuffer(0), [0, 0])],
  escape_time: [new FloatImage(new ArrayBuffer(0), [0, 0])],
}
