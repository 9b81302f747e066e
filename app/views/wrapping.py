"""Rows that wrap: side by side on a wide screen, below each other on a phone."""

from __future__ import annotations

from typing import Any

import panel as pn


def wrapping_row(*views: pn.viewable.Viewable, **options: Any) -> pn.FlexBox:
    """A row as high as its content: left alone, a FlexBox is cut at the height of the window, and what follows lies over it."""
    return pn.FlexBox(*views, styles={"max-height": "none"}, **options)
