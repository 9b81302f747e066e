// @ts-check
/**
 * A button that copies an image. Browsers allow copying only during the click, before the server has made the image: the
 * clipboard gets a promise of the image.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const button = document.createElement("button")
  Object.assign(button, {type: "button", className: "bk-btn bk-btn-default", textContent: model.label})
  const follow = () => (button.disabled = model.disabled)
  model.on("disabled", follow)
  follow()
  el.append(button)
  /** Passes the image to the clipboard; null unless a copy is in progress. @type {((image: ArrayBuffer | null) => void) | null} */
  let deliver = null
  button.addEventListener("click", async () => {
    if (deliver) return
    // Over http, except on localhost, navigator.clipboard is missing. Some browsers have no ClipboardItem.
    if (!navigator.clipboard?.write || !globalThis.ClipboardItem) {
      model.send_msg({copied: false})
      return
    }
    const image = new Promise(resolve => (deliver = resolve))
    model.send_msg({wanted: true})
    // If the server sends no image, it shows the reason, and nothing is reported here.
    const copied = await navigator.clipboard.write([new ClipboardItem({"image/png": image.then(asPng)})]).then(
      () => true,
      () => false,
    )
    if ((await image) !== null) model.send_msg({copied})
    deliver = null
  })
  model.on("msg:custom", (/** @type {{image: ArrayBuffer | null}} */ {image}) => deliver?.(image))
}

/** @param {ArrayBuffer | null} image */
function asPng(image) {
  if (image === null) throw new Error("there is no image")
  return new Blob([image], {type: "image/png"})
}
