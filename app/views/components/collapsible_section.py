"""A part of the page that is opened on demand."""

from __future__ import annotations

from collections.abc import Sequence

import panel as pn

from app.views.components.flex_row import FULL_HEIGHT, flex_row


class CollapsibleSection:
    """A title over a row that wraps; while it is closed its models are not part of the page, which saves time."""

    def __init__(self, title: str, columns: Sequence[pn.viewable.Viewable]) -> None:
        head = pn.pane.HTML(f"<h2>{title}</h2>", margin=(16, 10, 4, 10))
        self._content = [head, flex_row(*columns, justify="center")]
        self._column = pn.Column(sizing_mode="stretch_width", styles=FULL_HEIGHT)

    def layout(self) -> pn.viewable.Viewable:
        """The section as a part of the page."""
        return self._column

    def open(self, visible: bool) -> None:
        """Add the content to the page, or remove it."""
        self._column.objects = self._content if visible else []
