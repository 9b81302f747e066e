"""Sliders with a box for their number, which report each change."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import param

from app.browser.inputs.counted_input import CountedInput, finite_number
from app.browser.javascript import component_code


class ParameterSlider(CountedInput):
    """A slider with a box for its number. The number is final when the slider is released or left, or Enter is pressed.

    For a number beyond an end of the slider, the thumb is at that end.
    """

    low = param.Number(doc="left end of the slider")
    high = param.Number(doc="right end of the slider")
    lowest = param.Number(doc="smallest number of the box")
    highest = param.Number(doc="largest number of the box")
    step = param.Number(default=0.01)

    _esm = component_code(Path(__file__).with_suffix(".js"))

    def _checked(self, value: Any) -> float | None:
        number = finite_number(value)
        return number if number is not None and self.lowest <= number <= self.highest else None
