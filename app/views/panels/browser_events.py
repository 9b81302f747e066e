"""Events and services of the browser: history, width, keys, theme, touch and the clipboard."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

from app.state.view import PICTURES
from plots.layers import table

_TITLES = {"well": "the well"} | {name: picture.title for name, picture in table.PICTURES.items()}

PICTURE_KEYS: Mapping[str, str] = MappingProxyType({str(number): name for number, name in enumerate(PICTURES, 1)})
"""The picture that each key enlarges. A second press shows the picture at its usual size again."""

WINDOW_KEYS: Mapping[str, str] = MappingProxyType(
    {
        "ArrowLeft": "move left",
        "ArrowRight": "move right",
        "ArrowUp": "move up",
        "ArrowDown": "move down",
        "+": "zoom in",
        "-": "zoom out",
        "h": "whole plane",
    }
)
"""The action of each key that moves the window, by the key's name in `KeyboardEvent.key`."""

KEYS: Mapping[str, str] = MappingProxyType(
    {
        **WINDOW_KEYS,
        "b": "back",
        "f": "forward",
        "p": "play or stop the energy",
        "Enter": "orbit in the middle of the maps",
        "Escape": "show all pictures, or stop the computation",
        "?": "these keys",
        **{key: f"enlarge: {_TITLES[name]}" for key, name in PICTURE_KEYS.items()},
    }
)
"""The action of each key of the page, by the name of the key."""

# Labels of keys whose names are not their labels.
_KEY_LABELS = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓", "-": "−", "Escape": "Esc"}


# Bokeh does not register classes whose name starts with an underscore in the browser.
class BrowserListener(JSComponent):
    """Listens in the browser, and sends {key}, {link, entry, steps}, {dark}, {touch}, {narrow}, {enlarge} or {copied}."""

    keys = param.List(default=list(KEYS))
    address = param.Dict(default={}, doc="link of the view, its entry in the history, steps followed; number: see `command`")
    command = param.Dict(default={}, doc="name, such as back or copy; text to copy; number: makes equal commands differ")

    _esm = Path(__file__).with_suffix(".js")


@dataclass(frozen=True)
class BrowserActions:
    """Callbacks for the events, which run without the session's lock.

    Attributes
    ----------
    key
        Handles a key of `KEYS`, unless a field, slider or menu uses the key.
    navigate
        Shows the entry to which the browser's Back or Forward leads. The arguments are the query string and the number of the
        entry, and the number of such steps so far.
    dark
        Sets whether the theme is dark: after each change of the theme, and at the beginning of a dark page.
    touch
        Adapts the page to touch input.
    narrow
        Adapts the page to the layout of a phone, at the beginning or after a change of width.
    copied
        Takes whether the browser has copied the text.
    enlarge
        Handles a click on the button of the picture of this name.
    """

    key: Callable[[str], None]
    navigate: Callable[[str, int, int], None]
    dark: Callable[[bool], None]
    touch: Callable[[], None]
    narrow: Callable[[], None]
    copied: Callable[[bool], None]
    enlarge: Callable[[str], None]


class BrowserEvents:
    """Passes events of the browser to callbacks, and commands to the browser. Only the `keys` among `KEYS` are passed."""

    def __init__(self, actions: BrowserActions, keys: Collection[str] = KEYS) -> None:
        self._actions = actions
        self._keys = keys
        self._numbers = count()
        self._steps = 0
        self._listener = BrowserListener(keys=list(keys), width=0, height=0, margin=0, styles={"position": "absolute"})
        self._listener.on_msg(lambda event: self._receive(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """Return an invisible component that must be on the page."""
        return self._listener

    def copy(self, text: str | None) -> None:
        """Copy a text; None copies the address of the page. Browsers allow copying only soon after a click or a key."""
        self._command("copy", text=text)

    def write_link(self, link: str, entry: int) -> None:
        """Show a link as the address of the page, in this entry of the browser's history."""
        self._listener.address = {"link": link, "entry": entry, "steps": self._steps, "number": next(self._numbers)}

    def follow_steps(self, steps: int) -> None:
        """Note the number of steps in the history that the view has followed. Addresses with fewer steps are ignored."""
        self._steps = steps

    def go_back(self) -> None:
        """Go back in the browser's history."""
        self._command("back")

    def go_forward(self) -> None:
        """Go forward in the browser's history."""
        self._command("forward")

    def focus_drawer(self, is_open: bool) -> None:
        """Move the keyboard's focus into an opened drawer, or back to the place before the drawer opened."""
        self._command("focus" if is_open else "return")

    def _command(self, name: str, **details: Any) -> None:
        self._listener.command = {"name": name, **details, "number": next(self._numbers)}

    def _receive(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"key": str(key)} if key in self._keys:
                self._actions.key(key)
            case {"link": str(link), "entry": int(entry), "steps": int(steps)}:
                self._actions.navigate(link, entry, steps)
            case {"dark": bool(dark)}:
                self._actions.dark(dark)
            case {"touch": True}:
                self._actions.touch()
            case {"narrow": True}:
                self._actions.narrow()
            case {"copied": bool(success)}:
                self._actions.copied(success)
            case {"enlarge": str(name)} if name in PICTURES:
                self._actions.enlarge(name)


def key_legend() -> str:
    """Return an HTML list of all keys."""
    rows = (f"<dt><kbd>{_KEY_LABELS.get(key, key)}</kbd></dt><dd style='margin:0'>{action}</dd>" for key, action in KEYS.items())
    grid = "display:grid;grid-template-columns:max-content auto;gap:2px 12px;margin:0"
    return f'<dl style="{grid}">{"".join(rows)}</dl>'
