"""A slider and a box for a number: each one chosen arrives, and a number of the server does not replace a newer one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.callbacks import module_path


class ParameterSlider(JSComponent):
    """A slider with a box for its number.

    Parameters
    ----------
    on_chosen
        Called with each number, and whether it is done: the slider was released or left, or Enter was pressed. Runs without the
        session's lock.
    **options
        Parameters of the component.
    """

    label = param.String()
    low = param.Number(doc="left end of the slider")
    high = param.Number(doc="right end of the slider")
    lowest = param.Number(doc="smallest number of the box")
    highest = param.Number(doc="largest number of the box")
    step = param.Number(default=0.01)
    shown = param.Dict(
        default={"number": 1.0, "chosen": 0}, doc="the number, and how many chosen numbers the server has received"
    )

    _esm = module_path("parameter_slider.js")

    def __init__(self, on_chosen: Callable[[float, bool], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_chosen = on_chosen
        self.on_msg(lambda event: self._receive(event.data))

    def show(self, number: float) -> None:
        """Show a number; beyond the ends of the slider, its thumb is at the end."""
        self.shown = self.shown | {"number": number}

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"number": float() | int() as number, "chosen": int(chosen), "done": bool(done)} if (
                self.lowest <= number <= self.highest
            ):
                self.shown = {"number": float(number), "chosen": chosen}
                self._on_chosen(float(number), done)
