"""The base class of the components of the page, whose code browsers run as it is."""

from __future__ import annotations

import hashlib
from typing import Any

from bokeh.document import Document
from panel.custom import JSComponent

TRANSLATES = False
"""Whether browsers translate the code of components from TypeScript, as Panel does by default."""


class PlainComponent(JSComponent):
    """A component of Panel in JavaScript.

    In the browser Panel translates the code of each component from TypeScript, except that of a bundle. The translation takes a
    seventh of the time in which the page opens, and changes nothing in JavaScript, so the code is sent as that of a bundle.
    """

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        properties: dict[str, Any] = super()._get_properties(doc)
        if TRANSLATES:
            return properties
        # Panel keeps one module for each name of a bundle.
        return properties | {"bundle": hashlib.sha256(properties["esm"].encode()).hexdigest()}
