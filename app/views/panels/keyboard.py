"""Keys for the whole page, and two favours only the browser can do: know a new visitor, and copy the page's address."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

KEYS: Mapping[str, str] = MappingProxyType(
    {
        "ArrowLeft": "look further left",
        "ArrowRight": "look further right",
        "ArrowUp": "look further up",
        "ArrowDown": "look further down",
        "+": "zoom in",
        "-": "zoom out",
        "h": "home: the whole plane",
        "b": "back to the window before",
        "f": "forward again",
        "p": "play or pause the energy",
        "Escape": "stop what is being computed",
        "?": "help",
    }
)
"""What each key does, by the name that `on_key` is called with."""

_CAPS = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓", "-": "−", "Escape": "Esc"}

_LISTENER = """
const TYPING = `textarea, select, [contenteditable]:not([contenteditable=false]), [role=textbox], [role=searchbox],
  [role=combobox], [role=listbox], [role=menu], [role=menubar], [role=spinbutton], [role=grid], [role=tree],
  [role=alertdialog], [role=dialog]:not([aria-modal=false]),
  input:not([type=range], [type=checkbox], [type=radio], [type=button])`
const MOVING = `[type=range], [type=radio], [role=slider], [role=radio], [role=radiogroup], [role=tab], [role=tablist],
  [role=toolbar], [role=group]`
const VISITED = "escape-explorer-visited"
const REST_MS = 100

// The page is nested shadow roots: the event's target is only its outermost host, its path shows them all.
const comes_from = (event, places) => event.composedPath().some(node => node instanceof Element && node.matches(places))

function key_of(event, keys) {
  if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return null
  const named = event.key.length > 1
  if (named && event.shiftKey) return null
  const key = event.key === "=" ? "+" : named ? event.key : event.key.toLowerCase()
  if (!keys.includes(key) || comes_from(event, TYPING)) return null
  return key.startsWith("Arrow") && comes_from(event, MOVING) ? null : key
}

function is_first_visit() {
  try {
    const first = localStorage.getItem(VISITED) === null
    localStorage.setItem(VISITED, "yes")
    return first
  } catch {
    return false  // storage is blocked: better no greeting than one at every visit
  }
}

// navigator.clipboard is missing on plain http from another host; browsers may also refuse it.
const copy = text => Promise.resolve().then(() => navigator.clipboard.writeText(text)).then(() => true, () => copy_selected(text))

function copy_selected(text) {
  let focused = document.activeElement
  while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
  const area = document.createElement("textarea")
  area.value = text
  area.style.cssText = "position:fixed;opacity:0"
  document.body.append(area)
  area.select()
  const copied = document.execCommand("copy")
  area.remove()
  focused?.focus?.({preventScroll: true})
  return copied
}

export function render({model, el}) {
  let last = -REST_MS
  const listen = event => {
    const key = key_of(event, model.keys)
    if (key === null) return
    event.preventDefault()
    // A key held down repeats faster than pictures can follow.
    if (event.repeat && event.timeStamp - last < REST_MS) return
    last = event.timeStamp
    model.send_msg({key})
  }
  el.setAttribute("aria-hidden", "true")
  document.addEventListener("keydown", listen)
  model.on("lifecycle:remove", () => document.removeEventListener("keydown", listen))
  model.on("msg:custom", async () => model.send_msg({copied: await copy(window.location.href)}))
  if (is_first_visit()) model.send_msg({first_visit: true})
}
"""


# Its name has no underscore in front: Bokeh tells the browser of no such model.
class KeyListener(JSComponent):
    """The part in the browser; it sends {key}, {first_visit} or {copied}, and any message to it asks for a copy."""

    keys = param.List(default=list(KEYS))

    _esm = _LISTENER


class Keyboard:
    """Listens on the page unless a field, slider or menu wants the key; takes no room.

    `on_key(name)` is told of each key of `KEYS`, `on_first_visit()` once when this browser has not been here before,
    `on_copied(success)` how `copy_link` ended; all three, like a button's click, without the session's lock.
    """

    def __init__(
        self, on_key: Callable[[str], None], on_first_visit: Callable[[], None], on_copied: Callable[[bool], None]
    ) -> None:
        self._on_key, self._on_first_visit, self._on_copied = on_key, on_first_visit, on_copied
        self._listener = KeyListener(width=0, height=0, margin=0, styles={"position": "absolute"})
        self._listener.on_msg(lambda event: self._hear(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """Nothing to see, but it must be on the page."""
        return self._listener

    def copy_link(self) -> None:
        """Copy the page's present address to the clipboard; browsers allow it only soon after a click or a key."""
        self._listener._send_msg({})

    def _hear(self, message: Any) -> None:
        # It comes from a browser: whatever is not expected is not heard.
        match message:
            case {"key": str(key)} if key in KEYS:
                self._on_key(key)
            case {"first_visit": True}:
                self._on_first_visit()
            case {"copied": bool(success)}:
                self._on_copied(success)


def key_legend() -> str:
    """HTML of all keys with what they do."""
    rows = (f"<dt><kbd>{_CAPS.get(key, key)}</kbd></dt><dd style='margin:0'>{words}</dd>" for key, words in KEYS.items())
    grid = "display:grid;grid-template-columns:max-content auto;gap:2px 12px;margin:0;font-size:13px"
    return f'<dl style="{grid}">{"".join(rows)}</dl>'
