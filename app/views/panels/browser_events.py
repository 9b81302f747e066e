"""What only the browser has: its history, keys pressed anywhere on the page, theme, touch, a first visit, the clipboard."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import count
from types import MappingProxyType
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

KEYS: Mapping[str, str] = MappingProxyType(
    {
        "ArrowLeft": "move left",
        "ArrowRight": "move right",
        "ArrowUp": "move up",
        "ArrowDown": "move down",
        "+": "zoom in",
        "-": "zoom out",
        "h": "whole plane",
        "b": "back",
        "f": "forward",
        "p": "play or stop the energy",
        "Escape": "stop the computation",
        "?": "these keys",
    }
)
"""What each key does, by the name of the key in `KeyboardEvent.key`."""

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

// The target of an event is the outermost shadow host; its path has all elements.
const comes_from = (event, places) => event.composedPath().some(node => node instanceof Element && node.matches(places))

function key_of(event, keys) {
  if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return null
  const named = event.key.length > 1
  if (named && event.shiftKey) return null
  const key = event.key === "=" ? "+" : named ? event.key : event.key.toLowerCase()
  if (!keys.includes(key) || comes_from(event, TYPING)) return null
  // The browser closes an open help text.
  if (key === "Escape" && event.composedPath().some(node => node.popoverTargetElement?.matches(":popover-open"))) return null
  return key.startsWith("Arrow") && comes_from(event, MOVING) ? null : key
}

function is_first_visit() {
  try {
    const first = localStorage.getItem(VISITED) === null
    localStorage.setItem(VISITED, "yes")
    return first
  } catch {
    return false  // storage is blocked: no tour, rather than one at every visit
  }
}

// navigator.clipboard is missing on plain http except on localhost, and may be refused.
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
    if (key !== "Escape") event.preventDefault()
    // A key that is held down repeats faster than pictures are painted.
    if (event.repeat && event.timeStamp - last < REST_MS) return
    last = event.timeStamp
    model.send_msg({key})
  }
  el.setAttribute("aria-hidden", "true")
  document.addEventListener("keydown", listen)
  const tell_theme = () => model.send_msg({dark: document.documentElement.dataset.theme === "dark"})
  document.addEventListener("themechange", tell_theme)
  // Entries of the history have numbers: a new number is a new entry, the same one replaces the address.
  const page = crypto.getRandomValues(new Uint32Array(1))[0]
  let entry = 0
  // Steps through the history. An address that the server has sent before it knew of the last step is out of date.
  let steps = 0
  history.replaceState({page, entry}, "")
  model.on("address", () => {
    const {link, entry: next, steps: known} = model.address
    if (known !== steps) return
    history[next > entry ? "pushState" : "replaceState"]({page, entry: next}, "", link)
    entry = next
  })
  const tell_entry = event => {
    entry = event.state?.page === page ? event.state.entry : 0
    steps++
    model.send_msg({link: window.location.search, entry, steps})
  }
  window.addEventListener("popstate", tell_entry)
  // The browser would scroll the page when two fingers on a map move the same way.
  const hold_page = event => { if (event.touches.length > 1 && comes_from(event, ".map")) event.preventDefault() }
  document.addEventListener("touchstart", hold_page, {passive: false})
  model.on("lifecycle:remove", () => {
    document.removeEventListener("touchstart", hold_page)
    window.removeEventListener("popstate", tell_entry)
    document.removeEventListener("keydown", listen)
    document.removeEventListener("themechange", tell_theme)
  })
  if (document.documentElement.dataset.theme === "dark") tell_theme()
  model.on("command", async () => {
    const {name, text} = model.command
    if (name === "copy") model.send_msg({copied: await copy(text ?? window.location.href)})
    else history.go(name === "back" ? -1 : 1)
  })
  if (matchMedia("(pointer: coarse)").matches) model.send_msg({touch: true})
  if (is_first_visit()) model.send_msg({first_visit: true})
}
"""


# Bokeh does not register classes whose name starts with an underscore in the browser.
class BrowserListener(JSComponent):
    """The browser side: it sends {key}, {link, entry, steps}, {dark}, {touch}, {first_visit} or {copied}."""

    keys = param.List(default=list(KEYS))
    address = param.Dict(default={}, doc="link of the view, its entry in the history, steps known; number, see `command`")
    command = param.Dict(default={}, doc="name: back, forward or copy; text to copy; number that makes repeats differ")

    _esm = _LISTENER


@dataclass(frozen=True)
class BrowserActions:
    """Callbacks, which run without the session's lock.

    Attributes
    ----------
    key
        Called with each key of `KEYS`, except for keys that a field, slider or menu uses.
    navigate
        Called with the query string and the number of the entry that the browser's Back or Forward leads to, and the number
        of such steps so far.
    dark
        Called with whether the theme is dark, when it changes or is not light at the beginning.
    touch
        Called if the page is used by touch.
    first_visit
        Called if this browser opens the page for the first time.
    copied
        Called with the success of `copy`.
    """

    key: Callable[[str], None]
    navigate: Callable[[str, int, int], None]
    dark: Callable[[bool], None]
    touch: Callable[[], None]
    first_visit: Callable[[], None]
    copied: Callable[[bool], None]


class BrowserEvents:
    """Passes events of the browser to callbacks."""

    def __init__(self, actions: BrowserActions) -> None:
        self._actions = actions
        self._numbers = count()
        self._steps = 0
        self._listener = BrowserListener(width=0, height=0, margin=0, styles={"position": "absolute"})
        self._listener.on_msg(lambda event: self._receive(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """An invisible component that must be on the page."""
        return self._listener

    def copy(self, text: str | None) -> None:
        """Copy a text, or with None the page's address; browsers allow it only soon after a click or a key."""
        self._command("copy", text=text)

    def write_link(self, link: str, entry: int) -> None:
        """Show a link as the address of the page, as this entry of the browser's history."""
        self._listener.address = {"link": link, "entry": entry, "steps": self._steps, "number": next(self._numbers)}

    def follow_steps(self, steps: int) -> None:
        """The view follows the browser's history up to this number of steps; addresses written before are out of date."""
        self._steps = steps

    def go_back(self) -> None:
        """Do what the browser's Back does."""
        self._command("back")

    def go_forward(self) -> None:
        """Do what the browser's Forward does."""
        self._command("forward")

    def _command(self, name: str, **details: Any) -> None:
        self._listener.command = {"name": name, **details, "number": next(self._numbers)}

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"key": str(key)} if key in KEYS:
                self._actions.key(key)
            case {"link": str(link), "entry": int(entry), "steps": int(steps)}:
                self._actions.navigate(link, entry, steps)
            case {"dark": bool(dark)}:
                self._actions.dark(dark)
            case {"touch": True}:
                self._actions.touch()
            case {"first_visit": True}:
                self._actions.first_visit()
            case {"copied": bool(success)}:
                self._actions.copied(success)


def key_legend() -> str:
    """HTML list of all keys."""
    rows = (f"<dt><kbd>{_CAPS.get(key, key)}</kbd></dt><dd style='margin:0'>{action}</dd>" for key, action in KEYS.items())
    grid = "display:grid;grid-template-columns:max-content auto;gap:2px 12px;margin:0;font-size:13px"
    return f'<dl style="{grid}">{"".join(rows)}</dl>'
