// @ts-check
/** How long the address of a file is kept, in ms. */
const KEPT = 60000

/**
 * Saves the files that the server sends in the browser's download folder.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  el.setAttribute("aria-hidden", "true")
  model.on("msg:custom", (/** @type {{name: string, content: BlobPart}} */ {name, content}) => {
    const address = URL.createObjectURL(new Blob([content]))
    const link = Object.assign(document.createElement("a"), {href: address, download: name})
    document.body.append(link)
    link.click()
    link.remove()
    setTimeout(() => URL.revokeObjectURL(address), KEPT)
  })
}
