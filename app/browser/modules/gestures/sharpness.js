// @ts-check
/** Asks the server for maps with the pixels of the screen when nothing has changed for a while. */

import {mapPictures} from "../painting/pictures.js"
import {VIEW_REST_MS} from "../view_store.js"

/**
 * Send {pixels}, the largest side of a map on the screen, when the complete map of the server is at rest and has fewer pixels.
 * Send {pixels: 0} when a gesture begins, after which the finer map is not wanted.
 *
 * @param {any} maps  data source of the maps
 * @param {import("../view_store.js").ViewStore} store
 */
export function keepSharp(maps, {energy, window: shared, send}) {
  let isRequested = false
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let rest
  const request = () => {
    const {complete, fate} = maps.data
    const sides = mapPictures().map(({box}) => Math.max(box.width, box.height))
    const pixels = Math.round(devicePixelRatio * Math.max(...sides, 0))
    if (!complete[0] || fate[0].shape[0] >= pixels) return
    isRequested = true
    send({pixels})
  }
  const wait = () => {
    clearTimeout(rest)
    rest = setTimeout(request, VIEW_REST_MS)
  }
  const move = () => {
    wait()
    if (!isRequested || !(energy.isUnsent || shared.isUnsent)) return
    isRequested = false
    send({pixels: 0})
  }
  for (const value of [energy, shared]) value.listen(move)
  maps.connect(maps.properties.data.change, wait)
  // Enlarging a picture makes the others smaller, and so does a smaller window.
  const [first] = mapPictures()
  if (first) new ResizeObserver(wait).observe(first.view.el)
  wait()
}
