// @ts-check
/** Time after which the address of a file is revoked, in ms. The browser must have begun to save the file by then. */
const KEPT_MS = 60_000

/**
 * Save a file in the download folder of the browser.
 *
 * @param {string} name
 * @param {Blob} content
 */
export function saveFile(name, content) {
  const address = URL.createObjectURL(content)
  const link = Object.assign(document.createElement("a"), {href: address, download: name})
  document.body.append(link)
  link.click()
  link.remove()
  setTimeout(() => URL.revokeObjectURL(address), KEPT_MS)
}
