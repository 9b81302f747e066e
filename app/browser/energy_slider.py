"""The slider of the energy: it reports to the server when it is released, and to the engine in the browser on the way."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.callbacks import module_path

SHOWN = "energyshown"
"""Event of the page with the energy of the pictures while the server has not received it yet."""


class EnergySlider(JSComponent):
    """A slider for the energy.

    Parameters
    ----------
    on_release
        Called with each energy that the visitor chooses, without the session's lock.
    **options
        Parameters of the component.
    """

    title = param.String(default="Energy h", doc="name, shown before the number")
    note = param.String(doc="shown in place of name and number")
    low = param.Number(default=0.0, doc="left end")
    high = param.Number(default=1.0, doc="right end")
    decimals = param.Integer(default=3, doc="decimals of the energies that can be chosen")
    energy = param.Number(default=0.0, doc="energy of the server; beyond the ends, the thumb is at the end")
    disabled = param.Boolean()

    _esm = module_path("energy_slider.js")

    def __init__(self, on_release: Callable[[float], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_release = on_release
        self.on_msg(lambda event: self._receive(event.data))

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"energy": float() | int() as energy} if isfinite(energy) and not self.disabled:
                self._on_release(float(min(max(energy, self.low), self.high)))
