"""A box for a formula, which reports each change of the text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import param

from app.browser.inputs.counted_input import CountedInput
from app.browser.javascript import component_code

LONGEST_TYPED = 4000
"""Largest length of a text, in characters: larger than the limit for formulas, because the box cuts without a message."""


class FormulaBox(CountedInput):
    """A box for a formula. The text is final when Enter is pressed or the box is left."""

    placeholder = param.String(doc="text in an empty box")
    longest = param.Integer(default=LONGEST_TYPED, doc="largest length of the text, in characters")

    _esm = component_code(Path(__file__).with_suffix(".js"))

    def _checked(self, value: Any) -> str | None:
        return value if isinstance(value, str) and len(value) <= self.longest else None
