// @ts-check
/** Highlights the pixels of the legend entry under the pointer by fading all other colours. */

/** Opacity of the faded colours, as two hexadecimal digits. */
const FADED_ALPHA = "2e"

/** Return a palette "#rrggbb" in which all colours but one are faded. @type {(palette: string[], colour: string) => string[]} */
export const fade = (palette, colour) => palette.map(other => (other === colour ? other : other.slice(0, 7) + FADED_ALPHA))

/** Highlight the pixels of the legend entry under the pointer, for as long as the page exists. */
export function highlightPixels() {
  /** @type {{mapper: any, palette: string[], faded: string[]} | null} */
  let highlight = null
  /** @type {HTMLElement | undefined} */
  let lastEntry
  // Events "pointerover" do not leave a shadow tree that also contains the element before.
  document.addEventListener("pointermove", event => {
    const [entry, legend] = [".patch", ".foot"].map(selector => closest(event, selector))
    if (entry === lastEntry) return
    lastEntry = entry
    // If the server has set other colours in the meantime, they stay.
    if (highlight && highlight.mapper.palette === highlight.faded)
      highlight.mapper.setv({palette: highlight.palette}, {sync: false})
    highlight = null
    const mapper = legend && mapperOf(legend.dataset.picture)
    const colour = entry?.style.getPropertyValue("--colour")
    if (!mapper || !colour || !mapper.palette.includes(colour)) return
    highlight = {mapper, palette: mapper.palette, faded: fade(mapper.palette, colour)}
    mapper.setv({palette: highlight.faded}, {sync: false})
  })
}

/**
 * Return the innermost element of an event that matches a selector, also in a shadow tree.
 *
 * @type {(event: Event, selector: string) => HTMLElement | undefined}
 */
const closest = (event, selector) =>
  /** @type {HTMLElement | undefined} */ (
    event.composedPath().find(node => node instanceof HTMLElement && node.matches(selector))
  )

/**
 * Return the colour mapper of a picture.
 *
 * @param {string | undefined} picture  name of the picture
 */
function mapperOf(picture) {
  const view = [...Bokeh.index.all_views()].find(({model}) => model.type === "Figure" && model.name === picture)
  const renderer = view?.model.renderers.find((/** @type {any} */ each) => each.data_source.name === "maps")
  return renderer?.glyph.color_mapper
}
