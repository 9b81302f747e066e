"""The colours of HTML pages in both themes: one stylesheet for the explorer's page, live figures and the gallery."""

from __future__ import annotations

from functools import cache
from pathlib import Path


@cache
def page_colours() -> str:
    """Return a stylesheet that defines a property ``--ui-…`` for each colour.

    A colour is that of the theme in the property ``color-scheme`` of the element ``html``.
    """
    return Path(__file__).with_suffix(".css").read_text(encoding="utf-8")
