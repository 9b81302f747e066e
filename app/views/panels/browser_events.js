// @ts-check
/** Events and services of the browser: history, width, keys pressed anywhere on the page, theme, touch and the clipboard. */

// Elements that use letters, elements that use arrows, and elements that Enter presses.
const TYPING = `textarea, select, [contenteditable]:not([contenteditable=false]), [role=textbox], [role=searchbox],
  [role=combobox], [role=listbox], [role=menu], [role=menubar], [role=spinbutton], [role=grid], [role=tree],
  [role=alertdialog], [role=dialog]:not([aria-modal=false]),
  input:not([type=range], [type=checkbox], [type=radio], [type=button])`
const MOVING = `[type=range], [type=radio], [role=slider], [role=radio], [role=radiogroup], [role=tab], [role=tablist],
  [role=toolbar], [role=group]`
const PRESSED = "button, a[href], summary, input, [role=button]"
// Least time between two messages of a key that is held down.
const REST_MS = 100
// An opened drawer reaches the page after a few messages: how often to look for it, and the time between two tries.
const DRAWER_TRIES = 20
const WAIT_MS = 50

// The target of an event is only the outermost shadow host. Its path contains all elements.
/** @type {(event: Event, places: string) => boolean} */
const comes_from = (event, places) => event.composedPath().some(node => node instanceof Element && node.matches(places))

/** @param {any} node */
const opens_text = node => node.popoverTargetElement?.matches(":popover-open")

/** @param {KeyboardEvent} event @param {string[]} keys @returns {string | null} the key, if the page uses it here */
function key_of(event, keys) {
  if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return null
  const named = event.key.length > 1
  if (named && event.shiftKey) return null
  const key = event.key === "=" ? "+" : named ? event.key : event.key.toLowerCase()
  const closes = key === "Escape" && comes_from(event, ".drawer")
  if (!keys.includes(key) || (comes_from(event, TYPING) && !closes)) return null
  // The browser itself closes an open help text.
  if (key === "Escape" && event.composedPath().some(opens_text)) return null
  if (key === "Enter" && comes_from(event, PRESSED)) return null
  return key.startsWith("Arrow") && comes_from(event, MOVING) ? null : key
}

// navigator.clipboard is missing over http, except on localhost, and the browser may refuse its use.
/** @type {(text: string) => Promise<boolean>} */
const copy = text =>
  Promise.resolve()
    .then(() => navigator.clipboard.writeText(text))
    .then(
      () => true,
      () => copy_selected(text),
    )

/** @param {string} text */
function copy_selected(text) {
  const focused = focused_deep()
  const area = document.createElement("textarea")
  area.value = text
  area.style.cssText = "position:fixed;opacity:0"
  document.body.append(area)
  area.select()
  const copied = document.execCommand("copy")
  area.remove()
  focused?.focus({preventScroll: true})
  return copied
}

/**
 * The first element that matches, also within shadow roots.
 *
 * @type {(root: Document | ShadowRoot, selector: string) => HTMLElement | null}
 */
function find_deep(root, selector) {
  for (const element of root.querySelectorAll("*")) {
    if (element instanceof HTMLElement && element.matches(selector)) return element
    const inside = element.shadowRoot && find_deep(element.shadowRoot, selector)
    if (inside) return inside
  }
  return null
}

/** The element in focus, also within shadow roots. @returns {HTMLElement | null} */
function focused_deep() {
  let focused = document.activeElement
  while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
  return focused instanceof HTMLElement ? focused : null
}

/** Remove the frame that Bokeh draws around a picture in focus, unless the keyboard moved the focus. @param {Event} event */
function frame_focus(event) {
  const [focused] = event.composedPath()
  if (focused instanceof HTMLElement && focused.matches(".bk-events")) {
    focused.style.outlineWidth = focused.matches(":focus-visible") ? "" : "0"
  }
}

/** Focus the first control of the drawer, once the drawer is on the page. @param {number} tries */
function focus_drawer(tries) {
  const drawer = find_deep(document, ".drawer")?.shadowRoot
  const control = drawer && find_deep(drawer, "button, input, select, textarea")
  // The drawer may have focused a control already.
  if (control) {
    if (!find_deep(document, ".drawer")?.matches(":focus-within")) control.focus({preventScroll: true})
  } else if (tries > 0) setTimeout(() => focus_drawer(tries - 1), WAIT_MS)
}

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  let last = -REST_MS
  /** Where the focus was when a drawer was opened. @type {HTMLElement | null} */
  let opener = null
  const listen = (/** @type {KeyboardEvent} */ event) => {
    const key = key_of(event, model.keys)
    if (key === null) return
    if (key !== "Escape") event.preventDefault()
    // A key that is held down repeats faster than pictures are painted.
    if (event.repeat && event.timeStamp - last < REST_MS) return
    last = event.timeStamp
    model.send_msg({key})
  }
  el.setAttribute("aria-hidden", "true")
  document.addEventListener("keydown", listen)
  for (const name of ["focusin", "keydown"]) document.addEventListener(name, frame_focus)
  const tell_theme = () => model.send_msg({dark: document.documentElement.dataset.theme === "dark"})
  document.addEventListener("themechange", tell_theme)
  // Entries of the history are numbered: a higher number makes an entry, the same number replaces the address.
  const page = crypto.getRandomValues(new Uint32Array(1))[0]
  let entry = 0
  // Number of steps through the history. An address that the server sent before it knew the last step is out of date.
  let steps = 0
  history.replaceState({page, entry}, "")
  model.on("address", () => {
    const {link, entry: next, steps: known} = model.address
    if (known !== steps) return
    history[next > entry ? "pushState" : "replaceState"]({page, entry: next}, "", link)
    entry = next
  })
  const tell_entry = (/** @type {PopStateEvent} */ event) => {
    entry = event.state?.page === page ? event.state.entry : 0
    steps++
    model.send_msg({link: window.location.search, entry, steps})
  }
  window.addEventListener("popstate", tell_entry)
  // The stylesheet sets this variable only in the layout of a phone.
  const tell_if_narrow = () => {
    const frame = document.querySelector(".frame")
    if (frame === null || getComputedStyle(frame).getPropertyValue("--map-side") === "") return
    window.removeEventListener("resize", tell_if_narrow)
    model.send_msg({narrow: true})
  }
  window.addEventListener("resize", tell_if_narrow)
  // The buttons of the pictures.
  const enlarge = (/** @type {Event} */ event) => {
    const button = event.composedPath().find(node => node instanceof HTMLElement && node.matches("button[data-picture]"))
    if (button instanceof HTMLElement) model.send_msg({enlarge: button.dataset.picture})
  }
  document.addEventListener("click", enlarge)
  // Two fingers that move the same way on a map would scroll the page.
  const hold_page = (/** @type {TouchEvent} */ event) => {
    if (event.touches.length > 1 && comes_from(event, ".map")) event.preventDefault()
  }
  document.addEventListener("touchstart", hold_page, {passive: false})
  model.on("lifecycle:remove", () => {
    document.removeEventListener("touchstart", hold_page)
    document.removeEventListener("click", enlarge)
    window.removeEventListener("popstate", tell_entry)
    window.removeEventListener("resize", tell_if_narrow)
    document.removeEventListener("keydown", listen)
    for (const name of ["focusin", "keydown"]) document.removeEventListener(name, frame_focus)
    document.removeEventListener("themechange", tell_theme)
  })
  if (document.documentElement.dataset.theme === "dark") tell_theme()
  model.on("command", async () => {
    const {name, text} = model.command
    if (name === "copy") model.send_msg({copied: await copy(text ?? window.location.href)})
    else if (name === "focus") {
      opener = focused_deep()
      focus_drawer(DRAWER_TRIES)
    } else if (name === "return") opener?.focus({preventScroll: true})
    else history.go(name === "back" ? -1 : 1)
  })
  if (matchMedia("(pointer: coarse)").matches) model.send_msg({touch: true})
  tell_if_narrow()
}
