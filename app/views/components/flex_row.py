"""Rows that wrap: side by side on a wide screen, below each other on a phone."""

from __future__ import annotations

import panel as pn

FULL_HEIGHT = {"max-height": "none"}
"""Styles: by default Bokeh limits a layout to the height of the window, and what follows overlaps it."""


def flex_row(*views: pn.viewable.Viewable, justify: str = "flex-start", align: str = "flex-start", gap: str = "4px") -> pn.Column:
    """A row as high as its content.

    It is a Column with another flex direction: a Row would be at least as wide as all its children together.

    Parameters
    ----------
    *views
        What stands in it.
    justify, align, gap
        CSS values of justify-content, align-items and gap.
    """
    flow = {"flex-direction": "row", "flex-wrap": "wrap", "gap": gap}
    styles = FULL_HEIGHT | flow | {"justify-content": justify, "align-items": align}
    return pn.Column(*views, styles=styles, sizing_mode="stretch_width", margin=0)
