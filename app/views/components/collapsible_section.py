"""A part of the page that exists only while it is open."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import panel as pn

from app.views.components.flex_row import FULL_HEIGHT, flex_row

Build = Callable[[], Sequence[pn.viewable.Viewable]]
"""Makes the content of a section."""


class CollapsibleSection:
    """A title over a row that wraps; `build` makes the row each time the section is opened, and closing removes it."""

    def __init__(self, title: str, build: Build) -> None:
        self._title, self._build = title, build
        self._column = pn.Column(sizing_mode="stretch_width", styles=FULL_HEIGHT, visible=False)

    def layout(self) -> pn.viewable.Viewable:
        """The section as a part of the page."""
        return self._column

    @property
    def is_open(self) -> bool:
        """Whether the content is on the page."""
        return bool(self._column.objects)

    def open(self, visible: bool) -> None:
        """Build the content, or remove it."""
        if visible == self.is_open:
            return
        head = pn.pane.HTML(f"<h2>{self._title}</h2>", margin=(16, 10, 4, 10))
        content = [head, flex_row(*self._build(), justify="center")] if visible else []
        self._column.param.update(objects=content, visible=visible)

    def toggle(self) -> None:
        """Open the section, or close it."""
        self.open(not self.is_open)
