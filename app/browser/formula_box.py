"""A box for a formula. The server receives every typed text, and never replaces a text that is being typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.callbacks import module_path

LONGEST_TYPED = 4000
"""Most characters of a text. Formulas have a lower limit, which is checked later with a message; a box would cut silently."""


class FormulaBox(JSComponent):
    """A box for a formula.

    Parameters
    ----------
    on_typed
        Called with each text, and with whether it is finished by Enter or by leaving the box; runs without the session's lock.
    **options
        Parameters of the component.
    """

    label = param.String()
    placeholder = param.String(doc="shown in an empty box")
    longest = param.Integer(default=LONGEST_TYPED, doc="most characters of the text")
    shown = param.Dict(
        default={"text": "", "typed": 0}, doc="the text, and the number of typed texts that the server has received"
    )

    _esm = module_path("formula_box.js")

    def __init__(self, on_typed: Callable[[str, bool], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_typed = on_typed
        self.on_msg(lambda event: self._receive(event.data))

    @property
    def text(self) -> str:
        """The last text that the server has sent or received."""
        return str(self.shown["text"])

    def show(self, text: str) -> None:
        """Show a text."""
        self.shown = self.shown | {"text": text}

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"text": str(text), "typed": int(typed), "done": bool(done)} if len(text) <= self.longest:
                self.shown = {"text": text, "typed": typed}
                self._on_typed(text, done)
