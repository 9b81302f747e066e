"""Boxes for numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param

from app.browser.inputs.counted_input import CountedInput, finite_number
from app.browser.javascript import component_code


class NumberBox(CountedInput):
    """A box for a number with a label.

    Parameters
    ----------
    on_number
        Takes each final number, without the session's lock.
    number
        The initial number.
    **options
        Parameters of the component.
    """

    step = param.Number(default=0.1, doc="step of the arrow keys and buttons")
    shown_event = param.String(doc="browser event with a number to show that the server has not received")

    _esm = component_code(Path(__file__).with_suffix(".js"))

    def __init__(self, on_number: Callable[[float], None], number: float, **options: Any) -> None:
        super().__init__(lambda value, done: on_number(value), number, **options)

    def _checked(self, value: Any) -> float | None:
        return finite_number(value)
