// @ts-check
/** The places of the pictures on the screen. */

import {follow} from "./motion.js"

/**
 * A picture on the page: the view of Bokeh, and the box of its frame on the screen.
 *
 * @typedef {{view: any, box: DOMRect}} Picture
 */

/** The visible maps, in the order of the page. @returns {Picture[]} */
export function mapPictures() {
  // The server numbers the maps by tags, see `_paint` in `app/views/maps/map_plots.py`.
  const views = [...Bokeh.index.all_views()].filter(view => view.model.tags?.[0] === "map")
  views.sort((one, other) => one.model.tags[1] - other.model.tags[1])
  return views.map(withBox).filter(({box}) => box.width > 0)
}

/** The picture of the well; undefined on a narrow screen that shows a map. @returns {Picture | undefined} */
export const wellPicture = () => pictureNamed("well")

/** The picture or chart with a name; undefined if it is not visible. @param {string} name @returns {Picture | undefined} */
export function pictureNamed(name) {
  const view = [...Bokeh.index.all_views()].find(view => view.model.name === name)
  const picture = view && withBox(view)
  return picture?.box.width ? picture : undefined
}

/** @type {(view: any) => Picture} */
function withBox(view) {
  const canvas = view.canvas_view.el.getBoundingClientRect()
  const {left, top, width, height} = view.frame.bbox
  // The canvas of a picture that a narrow screen hides has no size: its box is empty.
  return {view, box: new DOMRect(canvas.left + left, canvas.top + top, canvas.width && width, canvas.height && height)}
}

/**
 * Call a function whenever the well or the first map has moved, or the theme has changed.
 *
 * @param {() => void} call
 * @returns {() => void} a function that ends the calls
 */
export const onMoved = call =>
  follow(() => [wellPicture()?.box, mapPictures()[0]?.box, devicePixelRatio, document.documentElement.dataset.theme], call)
