"""A part of the page that is only there while somebody wants it."""

from __future__ import annotations

from collections.abc import Sequence

import panel as pn
from bokeh.plotting import figure

from app.views.components.flex_row import AS_HIGH_AS_ITS_CONTENT, flex_row
from app.views.components.plots import dress


class Section:
    """A title over a row that wraps; out of the page, not merely hidden, while it is closed: every model there takes its time."""

    def __init__(self, title: str, columns: Sequence[pn.viewable.Viewable], figures: Sequence[figure]) -> None:
        self._figures = figures
        self._dark = False
        head = pn.pane.HTML(f"<h2 style='font-size:15px;margin:4px 0'>{title}</h2>", margin=(8, 10, 0, 10))
        self._content = [head, flex_row(*columns, justify_content="center", gap="4px")]
        self._column = pn.Column(sizing_mode="stretch_width", styles=AS_HIGH_AS_ITS_CONTENT)

    def layout(self) -> pn.viewable.Viewable:
        """Where it stands on the page."""
        return self._column

    def open(self, visible: bool) -> None:
        """Put it into the page, or take it out."""
        if visible:
            # What comes after the page has no theme.
            for plot in self._figures:
                dress(plot, dark=self._dark)
        self._column.objects = self._content if visible else []

    def set_dark(self, dark: bool) -> None:
        """Whether the page is dark when it is opened next; a page dresses what is in it by itself."""
        self._dark = dark
