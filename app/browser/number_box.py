"""A box for a number: each number that is typed arrives, and a number of the server does not replace one that is being typed."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.callbacks import module_path


class NumberBox(JSComponent):
    """A box for a number with a label.

    Boxes of Bokeh show each number of the server at once, also over a text that is being typed; and Panel drops a number that
    is typed while an earlier action, which sets another one, is still to be handled.

    Parameters
    ----------
    on_typed
        Called with each number that is typed, without the session's lock.
    number
        The number at first.
    **options
        Parameters of the component.
    """

    label = param.String()
    step = param.Number(default=0.1, doc="step of the arrow keys and buttons")
    disabled = param.Boolean()
    shown_event = param.String(doc="event of the page with a number to show that is not the server's")
    shown = param.Dict(default={}, doc="number, and how many typed ones the server knew of when it set this one")

    _esm = module_path("number_box.js")

    def __init__(self, on_typed: Callable[[float], None], number: float, **options: Any) -> None:
        super().__init__(shown={"number": number, "typed": 0}, **options)
        self._typed, self._on_typed = 0, on_typed
        self.on_msg(lambda event: self._receive(event.data))

    def show(self, number: float) -> None:
        """Show a number."""
        self.shown = {"number": number, "typed": self._typed}

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"number": float() | int() as number, "typed": int(typed)} if isfinite(number):
                self._typed = typed
                self._on_typed(float(number))
