// @ts-check
/** Images of pixels in the colours of a palette. */

/**
 * A linear or logarithmic scale of colours, in the form of Bokeh.
 *
 * @typedef {{type: string, palette: any[], low: number, high: number}} ColourMapper
 */

/** Paints images on canvases. */
export class PixelImage {
  #pixels = document.createElement("canvas")

  /**
   * Paint an image pixel by pixel, then enlarge it to the size of the box.
   *
   * @param {CanvasRenderingContext2D} context
   * @param {{width: number, height: number}} box
   * @param {any} image  numbers, with the numbers of rows and columns as `shape`
   * @param {ColourMapper} mapper
   */
  paint(context, box, image, mapper) {
    const [rows, columns] = image.shape
    const canvas = this.#pixels
    if (canvas.width !== columns || canvas.height !== rows) Object.assign(canvas, {width: columns, height: rows})
    const pixelContext = canvas.getContext("2d")
    if (!pixelContext) return
    const pixels = pixelContext.createImageData(columns, rows)
    mapColours(image, mapper, new Uint32Array(pixels.data.buffer), columns)
    pixelContext.putImageData(pixels, 0, 0)
    context.drawImage(canvas, 0, 0, box.width, box.height)
  }
}

/** Colours of palettes as 32-bit numbers for canvases. @type {WeakMap<any[], Uint32Array>} */
const colourTables = new WeakMap()

/**
 * Return the colour table of a palette.
 *
 * @param {any[]} palette  of "#rrggbb" or "#rrggbbaa", or of numbers 0xrrggbbaa
 */
function tableOf(palette) {
  const cachedTable = colourTables.get(palette)
  if (cachedTable) return cachedTable
  const table = Uint32Array.from(palette, colour => {
    // The bytes of a canvas are red, green, blue, alpha. A 32-bit number has its lowest byte first.
    const value = typeof colour === "number" ? colour : parseInt(colour.slice(1).padEnd(8, "f"), 16)
    return ((value & 0xff) << 24) | ((value & 0xff00) << 8) | ((value >>> 8) & 0xff00) | (value >>> 24)
  })
  colourTables.set(palette, table)
  return table
}

/**
 * Compute the colours of an image as the linear and logarithmic mappers of Bokeh do. An image begins with its lowest row, the
 * result with the highest row.
 *
 * @param {any} image  numbers, with NaN for no colour
 * @param {ColourMapper} mapper
 * @param {Uint32Array} colours  written, one for each number of the image
 * @param {number} columns  of the image
 */
export function mapColours(image, {type, palette, low, high}, colours, columns) {
  const table = tableOf(palette)
  const scale = type === "LogColorMapper" ? Math.log : (/** @type {number} */ value) => value
  const scaledLow = scale(low)
  const coloursPerUnit = table.length / (scale(high) - scaledLow)
  const rows = image.length / columns
  for (let i = 0; i < image.length; i++) {
    const index = Math.floor((scale(image[i]) - scaledLow) * coloursPerUnit)
    const row = rows - 1 - Math.floor(i / columns)
    colours[row * columns + (i % columns)] = Number.isNaN(image[i]) ? 0 : table[Math.min(Math.max(index, 0), table.length - 1)]
  }
}
