"""A box for a formula: each text that is typed arrives, and a text of the server does not replace one that is being typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import param
from panel.custom import JSComponent

from app.browser.callbacks import module_path

LONGEST_TYPED = 4000
"""Most characters of a text; formulas are shorter, but a box that cuts a text at their limit would not say so."""


class FormulaBox(JSComponent):
    """A box for a formula.

    Parameters
    ----------
    on_typed
        Called with each text, and whether it is done: Enter was pressed, or the box was left. Runs without the session's lock.
    **options
        Parameters of the component.
    """

    label = param.String()
    placeholder = param.String(doc="shown in an empty box")
    longest = param.Integer(default=LONGEST_TYPED, doc="most characters of the text")
    shown = param.Dict(default={"text": "", "typed": 0}, doc="text, and how many typed ones the server knows of")

    _esm = module_path("formula_box.js")

    def __init__(self, on_typed: Callable[[str, bool], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_typed = on_typed
        self.on_msg(lambda event: self._receive(event.data))

    @property
    def text(self) -> str:
        """The text in the browser, as far as the server knows."""
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
