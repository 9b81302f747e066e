"""The slider of the energy. It reports to the engine in the browser while it moves, and to the server when it is released."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param

from app.browser.inputs.counted_input import CountedInput, finite_number
from app.browser.javascript import component_code

SHOWN = "energyshown"
"""Browser event with the energy that the pictures show before the server has received it."""


class EnergySlider(CountedInput):
    """A slider for the energy. For an energy beyond an end of the slider, the thumb is at that end.

    Parameters
    ----------
    on_release
        Takes each energy that the visitor chooses, without the session's lock.
    energy
        The initial energy.
    **options
        Parameters of the component.
    """

    note = param.String(doc="text in place of name and number")
    low = param.Number(default=0.0, doc="left end")
    high = param.Number(default=1.0, doc="right end")
    decimals = param.Integer(default=3, doc="decimals of the energies that can be chosen")

    _esm = component_code(Path(__file__).with_suffix(".js"))

    def __init__(self, on_release: Callable[[float], None], energy: float, **options: Any) -> None:
        super().__init__(lambda value, done: on_release(value), energy, label="Energy h", **options)

    def _checked(self, value: Any) -> float | None:
        number = finite_number(value)
        return None if number is None or self.disabled else min(max(number, self.low), self.high)
