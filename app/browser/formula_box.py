"""A box for a formula: each text that is typed arrives."""

from __future__ import annotations

from typing import Any

import param

from app.browser.callbacks import component_code
from app.browser.counted_input import CountedInput

LONGEST_TYPED = 4000
"""Most characters of a text. Formulas have a lower limit, which is checked later with a message; a box would cut silently."""


class FormulaBox(CountedInput):
    """A box for a formula, which is done when Enter is pressed, or the box is left."""

    placeholder = param.String(doc="shown in an empty box")
    longest = param.Integer(default=LONGEST_TYPED, doc="most characters of the text")

    _esm = component_code("formula_box.js")

    def _checked(self, value: Any) -> str | None:
        return value if isinstance(value, str) and len(value) <= self.longest else None
