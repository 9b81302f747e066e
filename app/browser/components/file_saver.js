// @ts-check
import {saveFile} from "../modules/save_file.js"

/**
 * Saves each file that the server sends in the download folder of the browser.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  el.setAttribute("aria-hidden", "true")
  model.on("msg:custom", (/** @type {{name: string, content: BlobPart}} */ {name, content}) =>
    saveFile(name, new Blob([content])),
  )
}
