"""A part of the page that is built when it is first opened."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import panel as pn

from app.views.components.flex_row import FULL_HEIGHT, flex_row

Build = Callable[[], Sequence[pn.viewable.Viewable]]
"""Makes the content of a section."""


class CollapsibleSection:
    """A title over a row that wraps, made by `build` at the first opening; while it is closed it is not on the page."""

    def __init__(self, title: str, build: Build) -> None:
        self._title, self._build = title, build
        self._content: list[pn.viewable.Viewable] = []
        self._column = pn.Column(sizing_mode="stretch_width", styles=FULL_HEIGHT, visible=False)

    def layout(self) -> pn.viewable.Viewable:
        """The section as a part of the page."""
        return self._column

    @property
    def is_open(self) -> bool:
        """Whether the content is on the page."""
        return bool(self._column.objects)

    def open(self, visible: bool) -> None:
        """Put the content on the page, or take it off."""
        if visible and not self._content:
            head = pn.pane.HTML(f"<h2>{self._title}</h2>", margin=(16, 10, 4, 10))
            self._content = [head, flex_row(*self._build(), justify="center")]
        self._column.param.update(objects=self._content if visible else [], visible=visible)

    def toggle(self) -> None:
        """Open the section, or close it."""
        self.open(not self.is_open)
