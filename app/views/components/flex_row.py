"""Rows that wrap: side by side on a wide screen, below each other on a phone."""

from __future__ import annotations

import panel as pn

FULL_HEIGHT = {"max-height": "none"}
"""Styles: by default Bokeh limits a layout to the height of the window, and what follows overlaps it."""


def flex_row(*views: pn.viewable.Viewable, justify: str = "start", align: str = "start", gap: str = "4px") -> pn.Column:
    """A row as high as its content.

    It is a Column with another flex direction: a Row would be at least as wide as all its children together.

    Parameters
    ----------
    *views
        Children of the row.
    justify
        Horizontal place of the children, a CSS value of justify-content.
    align
        Vertical place of each child: start, center or end.
    gap
        Space between the children, a CSS length.
    """
    for view in views:
        view.align = align
    styles = {"flex-direction": "row", "flex-wrap": "wrap", "justify-content": justify, "gap": gap}
    return pn.Column(*views, styles=FULL_HEIGHT | styles, sizing_mode="stretch_width", margin=0)
