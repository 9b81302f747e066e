// @ts-check
/** What the page does without a connection: nothing can be used, and the page is loaded again when the server answers. */

/** Shortest time between two requests to the server, in ms. */
const TRY_MS = 3000
/** Longest additional time, in ms, so that the pages of a server do not return all at once. */
const SPREAD_MS = 5000

/** Load the page again when the server answers a request for a file of the page. @param {string} file */
function reloadWhenAnswered(file) {
  const ask = async () => {
    const response = await fetch(file, {method: "HEAD", cache: "no-store"}).catch(() => null)
    if (response?.ok) location.reload()
    else reloadWhenAnswered(file)
  }
  setTimeout(ask, TRY_MS + SPREAD_MS * Math.random())
}

/**
 * Show a dialog over the page, which cannot be used any more.
 *
 * @param {string} sentence
 * @param {string} label  of the button that loads the page again at once
 */
export function showLostConnection(sentence, label) {
  const [dialog, text, button] = ["dialog", "p", "button"].map(name => document.createElement(name))
  if (!(dialog instanceof HTMLDialogElement)) return
  dialog.className = "notice lost"
  dialog.setAttribute("aria-label", sentence)
  dialog.addEventListener("cancel", event => event.preventDefault())
  text.textContent = sentence
  button.textContent = label
  button.addEventListener("click", () => location.reload())
  dialog.append(text, button)
  document.body.append(dialog)
  dialog.showModal()
  const script = document.querySelector("script[src]")
  if (script instanceof HTMLScriptElement) reloadWhenAnswered(script.src)
}
