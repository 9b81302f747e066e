"""Rows that wrap: side by side on a wide screen, below each other on a phone."""

from __future__ import annotations

from typing import Any

import panel as pn

AS_HIGH_AS_ITS_CONTENT = {"max-height": "none"}
"""Styles: left alone, a layout is cut at the height of the window, and what follows lies over it."""


def flex_row(*views: pn.viewable.Viewable, **options: Any) -> pn.FlexBox:
    """A row as high as its content."""
    return pn.FlexBox(*views, styles=AS_HIGH_AS_ITS_CONTENT, **options)
