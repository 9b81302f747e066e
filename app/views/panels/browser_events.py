"""Events and services of the browser: history, width, keys, touch and the clipboard."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any

import param

from app.browser.components.plain_component import PlainComponent
from app.browser.module_files import TOUR_ADDRESS
from app.job_clients.latest_request import Locked
from app.state.navigation import WINDOW_MOVES
from app.state.tour import TOUR
from app.state.view import PICTURES
from app.state.view_state import ViewState
from app.state.watched_starts import WATCH_KEY
from plots.layers import table

_TITLES = {"well": "the well"} | {name: picture.title for name, picture in table.PICTURES.items()}

PICTURE_KEYS: Mapping[str, str] = MappingProxyType({str(number): name for number, name in enumerate(PICTURES, 1)})
"""The picture that each key enlarges. A second press shows the picture at its usual size again."""

KEYS: Mapping[str, str] = MappingProxyType(
    {
        **{key: move.label for key, move in WINDOW_MOVES.items()},
        "b": "go back",
        "f": "go forward",
        "p": "play or stop the animation of the energy",
        WATCH_KEY: "watch many orbits leave, or pause",
        "Enter": "add the orbit that starts in the middle of the maps",
        "Escape": "close the drawer, stop the animation, show all pictures, or stop the computation",
        "?": "open or close the help",
        **{key: f"enlarge: {_TITLES[name]}" for key, name in PICTURE_KEYS.items()},
    }
)
"""The action of each key of the page, by the name of the key."""

# Labels of keys in the legend that differ from the name in `KeyboardEvent.key`.
_KEY_LABELS = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓", "-": "−", "Escape": "Esc"}


class BrowserEvents(PlainComponent):
    """An invisible component that passes browser events to the view state or to callbacks, and sends commands to the browser.

    The browser sends {key}, {link, entry, steps}, {touch}, {narrow}, {enlarge} or {copied}. It receives

    - `address`: {link, entry, steps, number}, the link of the view, the number of its entry in the history, the number of steps
      through the history that the view has followed, and a serial number,
    - `command`: {name, number}, with a text to copy, or with the address of the module and the steps of the tour; the name is
      copy, back, forward, focus, return or tour.

    The serial number makes equal addresses and equal commands differ.

    Parameters
    ----------
    state
        View state, whose `touch`, `narrow` and enlarged picture are set.
    keys
        Some of `KEYS`, which the page uses unless a field, slider or menu uses them.
    locked
        Wraps a function to run under the session's lock. Events can arrive before the page is ready, when `pn.io.hold` fails.
    on_key
        Handles one of the keys.
    on_navigate
        Called when the browser's Back or Forward leads to an entry of the history, with the query string and the number of the
        entry, and the number of such steps so far.
    on_copied
        Called after a copy, with True if the text was copied.
    """

    keys = param.List(default=list(KEYS), doc="names of the keys that the page uses")
    address = param.Dict(default={}, doc="the latest address, see the class")
    command = param.Dict(default={}, doc="the latest command, see the class")

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
        self._send_command("copy", text=text)

    def show_address(self, link: str, entry: int) -> None:
        """Show a link as the address of the page, in this entry of the browser's history."""
        self.address = {"link": link, "entry": entry, "steps": self._steps, "number": next(self._numbers)}

    def follow_steps(self, steps: int) -> None:
        """Note the number of steps in the history that the view has followed. Addresses with fewer steps are ignored."""
        self._steps = steps

    def go_back(self) -> None:
        """Go back in the browser's history."""
        self._send_command("back")

    def go_forward(self) -> None:
        """Go forward in the browser's history."""
        self._send_command("forward")

    def focus_drawer(self, is_open: bool) -> None:
        """Move the keyboard's focus into an opened drawer, or back to the place before the drawer opened."""
        self._send_command("focus" if is_open else "return")

    def begin_tour(self) -> None:
        """Begin the tour at its first step. No other command may be sent with the same message."""
        self._send_command("tour", address=TOUR_ADDRESS, steps=[asdict(step) for step in TOUR])

    def _send_command(self, name: str, **details: Any) -> None:
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
