// @ts-check
/** Time after which the address of a file is revoked, in ms. The browser must have begun to save the file by then. */
const KEPT_MS = 60_000

/**
 * Saves each file that the server sends in the download folder of the browser.
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
    setTimeout(() => URL.revokeObjectURL(address), KEPT_MS)
  })
}
