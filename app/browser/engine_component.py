"""The engine in the visitor's browser: previews while the energy or the window changes, and the orbit under the cursor."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from math import isfinite
from pathlib import Path
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.browser_system import BrowserSystem
from app.browser.module_files import ADDRESS


class EngineComponent(JSComponent):
    """Runs the engine in the browser, and sends {energy} when an animation of the energy has ended."""

    address = param.String(doc="address of the first module")
    system = param.Dict(default={}, doc="see `BrowserSystem.to_dict`")
    view = param.Dict(default={}, doc="see `BrowserEngine.show_view`")
    command = param.Dict(default={}, doc="name: play or stop; energy, low, high; number: makes equal commands differ")

    _esm = Path(__file__).with_suffix(".js")


class BrowserEngine(param.Parameterized):
    """Sends the system and the view of the page to the engine in the browser.

    Parameters
    ----------
    on_energy
        Takes the energy at which an animation ends.
    """

    playing = param.Boolean(default=False, doc="whether an animation of the energy is running")

    def __init__(self, on_energy: Callable[[float], None]) -> None:
        super().__init__()
        self._on_energy = on_energy
        self._numbers = count()
        options = {"width": 0, "height": 0, "margin": 0, "styles": {"position": "absolute"}, "css_classes": ["engine"]}
        self._component = EngineComponent(address=ADDRESS, **options)
        self._component.on_msg(lambda event: self._receive(event.data))

    def layout(self) -> EngineComponent:
        """Return an invisible component that must be on the page."""
        return self._component

    def show_system(self, system: BrowserSystem) -> None:
        """Send the system that the page shows or is about to show."""
        self._component.system = system.to_dict()

    def show_view(self, view: dict[str, Any]) -> None:
        """Send the view of the page, in the form of `app.browser.views.describe_view`."""
        self._component.view = view

    def play(self, energy: float, low: float, high: float) -> None:
        """Animate the energy from `energy` up to `high`, or from `low` if `energy` is the end of the range."""
        self.playing = True
        self._component.command = {"name": "play", "energy": energy, "low": low, "high": high, "number": next(self._numbers)}

    def stop(self) -> None:
        """Stop the animation at the current energy."""
        if self.playing:
            self._component.command = {"name": "stop", "number": next(self._numbers)}

    def _receive(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"energy": float() | int() as energy} if self.playing and isfinite(energy):
                self.playing = False
                self._on_energy(float(energy))
