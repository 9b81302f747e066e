// @ts-check
/** Highlights the pixels of the legend entry under the pointer, as all other colours fade. */

/** Opacity of the faded colours, as two hexadecimal digits. */
const FADED = "2e"

/** Fade all colours of a palette but one. @type {(palette: string[], colour: string) => string[]} */
export const fade = (palette, colour) => palette.map(other => (other === colour ? other : other.slice(0, 7) + FADED))

/** Highlight pixels from now on, as long as the page exists. */
export function lightPixels() {
  /** @type {{mapper: any, palette: string[], faded: string[]} | null} */
  let lit = null
  document.addEventListener("pointerover", event => {
    // The server may have set other colours in the meantime.
    if (lit && lit.mapper.palette === lit.faded) lit.mapper.setv({palette: lit.palette}, {sync: false})
    lit = null
    const [item, foot] = [".patch", ".foot"].map(places => closest(event, places))
    const mapper = foot && mapperOf(foot.dataset.picture)
    const colour = item?.style.getPropertyValue("--colour")
    if (!mapper || !colour || !mapper.palette.includes(colour)) return
    lit = {mapper, palette: mapper.palette, faded: fade(mapper.palette, colour)}
    mapper.setv({palette: lit.faded}, {sync: false})
  })
}

/** @type {(event: Event, places: string) => HTMLElement | undefined} */
const closest = (event, places) =>
  /** @type {HTMLElement | undefined} */ (event.composedPath().find(node => node instanceof HTMLElement && node.matches(places)))

/**
 * The colour mapper of a picture.
 *
 * @param {string | undefined} picture
 */
function mapperOf(picture) {
  const view = [...Bokeh.index.all_views()].find(({model}) => model.type === "Figure" && model.name === picture)
  const renderer = view?.model.renderers.find((/** @type {any} */ each) => each.data_source.name === "maps")
  return renderer?.glyph.color_mapper
}
