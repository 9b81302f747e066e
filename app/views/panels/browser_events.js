// @ts-check
/** Events and services of the browser: history, width, keys pressed anywhere on the page, touch and the clipboard. */

/** Elements that use letters, so that the page does not. */
const TEXT_TARGETS = `textarea, select, [contenteditable]:not([contenteditable=false]), [role=textbox], [role=searchbox],
  [role=combobox], [role=listbox], [role=menu], [role=menubar], [role=spinbutton], [role=grid], [role=tree],
  [role=alertdialog], [role=dialog]:not([aria-modal=false]),
  input:not([type=range], [type=checkbox], [type=radio], [type=button])`
/** Elements that use arrow keys. Pictures are groups that leave them to the page. */
const ARROW_TARGETS = `[type=range], [type=radio], [role=slider], [role=radio], [role=radiogroup], [role=tab], [role=tablist],
  [role=toolbar], [role=group]:not(.bk-Figure)`
/** Elements that the Enter key presses. */
const ENTER_TARGETS = "button, a[href], summary, input, [role=button]"
/** Smallest time between two messages of a key that is held down, in ms. */
const KEY_INTERVAL_MS = 100
/** Number of tries to find an opened drawer, which reaches the page after a few messages. */
const DRAWER_TRIES = 20
/** Time between two tries, in ms. */
const DRAWER_INTERVAL_MS = 50

// The target of an event is only the outermost shadow host. Its path contains all elements.
/** Whether an element that matches contains the target. @type {(event: Event, selector: string) => boolean} */
const comesFrom = (event, selector) => event.composedPath().some(node => node instanceof Element && node.matches(selector))

/** @param {any} node */
const opensHelpText = node => node.popoverTargetElement?.matches(":popover-open")

/** @param {KeyboardEvent} event @param {string[]} keys @returns {string | null} the key, if the page uses it here */
function pageKey(event, keys) {
  if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return null
  const isNamed = event.key.length > 1
  if (isNamed && event.shiftKey) return null
  const key = event.key === "=" ? "+" : isNamed ? event.key : event.key.toLowerCase()
  const closesDrawer = key === "Escape" && comesFrom(event, ".drawer")
  if (!keys.includes(key) || (comesFrom(event, TEXT_TARGETS) && !closesDrawer)) return null
  // The browser itself closes an open help text.
  if (key === "Escape" && event.composedPath().some(opensHelpText)) return null
  if (key === "Enter" && comesFrom(event, ENTER_TARGETS)) return null
  return key.startsWith("Arrow") && comesFrom(event, ARROW_TARGETS) ? null : key
}

// Over http, except on localhost, navigator.clipboard is missing. The browser may also refuse its use.
/** @type {(text: string) => Promise<boolean>} */
const copy = text =>
  Promise.resolve()
    .then(() => navigator.clipboard.writeText(text))
    .then(
      () => true,
      () => copySelection(text),
    )

/** Copy a text by selecting it, without navigator.clipboard. @param {string} text */
function copySelection(text) {
  const focused = focusedElement()
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
function findElement(root, selector) {
  for (const element of root.querySelectorAll("*")) {
    if (element instanceof HTMLElement && element.matches(selector)) return element
    const descendant = element.shadowRoot && findElement(element.shadowRoot, selector)
    if (descendant) return descendant
  }
  return null
}

/** The element in focus, also within shadow roots. @returns {HTMLElement | null} */
function focusedElement() {
  let focused = document.activeElement
  while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
  return focused instanceof HTMLElement ? focused : null
}

/**
 * Give a picture in focus a role and the name of its group, because Bokeh gives none. Remove the frame that Bokeh draws around it,
 * unless the keyboard moved the focus.
 *
 * @param {Event} event
 */
function updateFocusedPicture(event) {
  const [focused, ...around] = event.composedPath()
  if (!(focused instanceof HTMLElement && focused.matches(".bk-events"))) return
  const group = around.find(node => node instanceof Element && node.matches("[role=group]"))
  focused.setAttribute("role", "img")
  if (group instanceof Element) focused.setAttribute("aria-label", group.getAttribute("aria-label") ?? "")
  focused.style.outlineWidth = focused.matches(":focus-visible") ? "" : "0"
}

/** Focus the first control of the drawer, once the drawer is on the page. @param {number} tries */
function focusDrawer(tries) {
  const drawer = findElement(document, ".drawer")?.shadowRoot
  const control = drawer && findElement(drawer, "button, input, select, textarea")
  // The drawer may have focused a control already.
  if (control) {
    if (!findElement(document, ".drawer")?.matches(":focus-within")) control.focus({preventScroll: true})
  } else if (tries > 0) setTimeout(() => focusDrawer(tries - 1), DRAWER_INTERVAL_MS)
}

/**
 * Lay out the parts of the page again. Bokeh does so when the box of a root changes. In narrow windows the roots have no boxes, and
 * pictures would keep the size of the former window.
 */
function layOutRootsWithoutBoxes() {
  const roots = Bokeh.index.roots.filter(view => getComputedStyle(view.el).display === "contents")
  requestAnimationFrame(() => roots.forEach(view => view.compute_layout()))
}

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  let lastKeyTime = -KEY_INTERVAL_MS
  /** Where the focus was when a drawer was opened. @type {HTMLElement | null} */
  let opener = null
  const sendKey = (/** @type {KeyboardEvent} */ event) => {
    const key = pageKey(event, model.keys)
    if (key === null) return
    if (key !== "Escape") event.preventDefault()
    // A key that is held down repeats faster than pictures are painted.
    if (event.repeat && event.timeStamp - lastKeyTime < KEY_INTERVAL_MS) return
    lastKeyTime = event.timeStamp
    model.send_msg({key})
  }
  el.setAttribute("aria-hidden", "true")
  document.addEventListener("keydown", sendKey)
  for (const name of ["focusin", "keydown"]) document.addEventListener(name, updateFocusedPicture)
  // Entries of the history are numbered. An address with a higher number makes a new entry; others replace the present address.
  const page = crypto.getRandomValues(new Uint32Array(1))[0]
  let entry = 0
  // Number of steps through the history. An address that the server sent before it knew the last step is out of date.
  let steps = 0
  history.replaceState({page, entry}, "")
  model.on("address", () => {
    const {link, entry: newEntry, steps: knownSteps} = model.address
    if (knownSteps !== steps) return
    history[newEntry > entry ? "pushState" : "replaceState"]({page, entry: newEntry}, "", link)
    entry = newEntry
  })
  const sendEntry = (/** @type {PopStateEvent} */ event) => {
    entry = event.state?.page === page ? event.state.entry : 0
    steps++
    model.send_msg({link: window.location.search, entry, steps})
  }
  window.addEventListener("popstate", sendEntry)
  // The stylesheet sets this variable only in the layout of a phone.
  const sendIfNarrow = () => {
    const frame = document.querySelector(".frame")
    if (frame === null || getComputedStyle(frame).getPropertyValue("--map-side") === "") return
    window.removeEventListener("resize", sendIfNarrow)
    model.send_msg({narrow: true})
  }
  for (const react of [sendIfNarrow, layOutRootsWithoutBoxes]) window.addEventListener("resize", react)
  // A button of a picture sends the name of the picture, or the key that does the same.
  const press = (/** @type {Event} */ event) => {
    const button = event.composedPath().find(node => node instanceof HTMLButtonElement)
    if (!(button instanceof HTMLButtonElement)) return
    const {picture, key} = button.dataset
    if (picture !== undefined) model.send_msg({enlarge: picture})
    if (key !== undefined) model.send_msg({key})
  }
  document.addEventListener("click", press)
  // The browser would scroll the page when two fingers move the same way on a map.
  const preventScroll = (/** @type {TouchEvent} */ event) => {
    if (event.touches.length > 1 && comesFrom(event, ".map")) event.preventDefault()
  }
  document.addEventListener("touchstart", preventScroll, {passive: false})
  model.on("lifecycle:remove", () => {
    document.removeEventListener("touchstart", preventScroll)
    document.removeEventListener("click", press)
    window.removeEventListener("popstate", sendEntry)
    for (const react of [sendIfNarrow, layOutRootsWithoutBoxes]) window.removeEventListener("resize", react)
    document.removeEventListener("keydown", sendKey)
    for (const name of ["focusin", "keydown"]) document.removeEventListener(name, updateFocusedPicture)
  })
  model.on("command", async () => {
    const {name, text, address, steps: tour} = model.command
    if (name === "copy") model.send_msg({copied: await copy(text ?? window.location.href)})
    else if (name === "focus") {
      opener = focusedElement()
      focusDrawer(DRAWER_TRIES)
    } else if (name === "return") opener?.focus({preventScroll: true})
    else if (name === "tour") {
      const {startTour} = await import(new URL(address, document.baseURI).href)
      startTour(tour, focusedElement())
    } else history.go(name === "back" ? -1 : 1)
  })
  if (matchMedia("(pointer: coarse)").matches) model.send_msg({touch: true})
  sendIfNarrow()
}
