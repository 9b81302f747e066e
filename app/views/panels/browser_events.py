"""Events and services of the browser: history, width, keys, touch and the clipboard."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any

import param
from panel.custom import JSComponent

from app.job_clients.latest_request import Locked
from app.state.navigation import WINDOW_MOVES
from app.state.view import PICTURES
from app.state.view_state import ViewState
from plots.layers import table

_TITLES = {"well": "the well"} | {name: picture.title for name, picture in table.PICTURES.items()}

PICTURE_KEYS: Mapping[str, str] = MappingProxyType({str(number): name for number, name in enumerate(PICTURES, 1)})
"""The picture that each key enlarges. A second press shows the picture at its usual size again."""

KEYS: Mapping[str, str] = MappingProxyType(
    {
        **{key: move.words for key, move in WINDOW_MOVES.items()},
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


class BrowserEvents(JSComponent):
    """An invisible component that passes events of the browser to the view state or to callbacks, and commands to the browser.

    The browser sends {key}, {link, entry, steps}, {touch}, {narrow}, {enlarge} or {copied}.

    Parameters
    ----------
    state
        View state, which gets touch, width and the enlarged picture.
    keys
        Some of `KEYS`, which the page uses unless a field, slider or menu uses them.
    locked
        Wraps a function to run under the session's lock. `pn.io.hold` would fail for events that arrive before the page is ready.
    on_key
        Handles one of the keys.
    on_navigate
        Shows the entry to which the browser's Back or Forward leads, given by query string and number, and notes the number of
        such steps so far.
    on_copied
        Handles whether a text could be copied.
    """

    keys = param.List(default=list(KEYS), doc="names of the keys that the page uses")
    address = param.Dict(default={}, doc="link of the view, its entry in the history, steps followed; number: see `command`")
    command = param.Dict(default={}, doc="name, such as back or copy; text to copy; number: makes equal commands differ")

    _esm = Path(__file__).with_suffix(".js")

    def __init__(
        self,
        state: ViewState,
        keys: Collection[str],
        locked: Locked,
        on_key: Callable[[str], None],
        on_navigate: Callable[[str, int, int], None],
        on_copied: Callable[[bool], None],
    ) -> None:
        super().__init__(keys=list(keys), width=0, height=0, margin=0, styles={"position": "absolute"})
        self._on_key, self._on_navigate, self._on_copied = locked(on_key), locked(on_navigate), locked(on_copied)
        self._update, self._enlarge = locked(state.param.update), locked(state.enlarge)
        self._numbers = count()
        self._steps = 0

    def copy(self, text: str | None) -> None:
        """Copy a text; None copies the address of the page. Browsers allow copying only soon after a click or a key."""
        self._command("copy", text=text)

    def write_link(self, link: str, entry: int) -> None:
        """Show a link as the address of the page, in this entry of the browser's history."""
        self.address = {"link": link, "entry": entry, "steps": self._steps, "number": next(self._numbers)}

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
        self.command = {"name": name, **details, "number": next(self._numbers)}

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"key": str(key)} if key in self.keys:
                self._on_key(key)
            case {"link": str(link), "entry": int(entry), "steps": int(steps)}:
                self._on_navigate(link, entry, steps)
            case {"touch": True}:
                self._update(touch=True)
            case {"narrow": True}:
                self._update(narrow=True)
            case {"copied": bool(success)}:
                self._on_copied(success)
            case {"enlarge": str(name)} if name in PICTURES:
                self._enlarge(name)


def key_legend() -> str:
    """Return an HTML list of all keys."""
    rows = (f"<dt><kbd>{_KEY_LABELS.get(key, key)}</kbd></dt><dd style='margin:0'>{action}</dd>" for key, action in KEYS.items())
    grid = "display:grid;grid-template-columns:max-content auto;gap:2px 12px;margin:0"
    return f'<dl style="{grid}">{"".join(rows)}</dl>'
