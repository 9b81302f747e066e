"""Widgets and rows of Panel with accessible names and with the classes of the stylesheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ClassVar

import panel as pn
import param
from bokeh.document import Document

COUNT_WHOLE = "Count the whole view"
"""Label of the buttons that remove the box."""

FULL_HEIGHT = {"max-height": "none"}
"""By default Bokeh limits a layout to the height of the window, so that the following parts overlap it."""

Rows = Iterable[Sequence[str]]
"""The texts of the cells."""


class _NamedGroup:
    """Mixin: the widget's element gets a role and its label as accessible name, which Bokeh does not set."""

    _role: ClassVar[str] = "group"

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        properties: dict[str, Any] = super()._get_properties(doc)  # type: ignore[misc]
        return {**properties, "html_attributes": {"role": self._role, "aria-label": self.label}}  # type: ignore[attr-defined]


class SegmentedControl(_NamedGroup, pn.widgets.RadioBoxGroup):
    """Radio buttons drawn as one segmented control."""

    _role = "radiogroup"

    def __init__(self, **options: Any) -> None:
        super().__init__(inline=True, **({"css_classes": ["segmented"]} | options))


class Switches(_NamedGroup, pn.widgets.CheckBoxGroup):
    """Checkboxes drawn as switches; `value` lists those that are on."""

    def __init__(self, **options: Any) -> None:
        super().__init__(inline=True, css_classes=["switches"], **options)


def button(label: str, on_click: Callable[[], Any], *, kind: str = "default", **options: Any) -> pn.widgets.Button:
    """Return a button; `kind` is "default", "primary" for the main action of a section, or "light" for one without a frame."""

    def click(event: Any) -> None:
        # Panel runs callbacks of widgets without the session's lock, which changes of plain Bokeh models need; `hold` provides
        # it.
        with pn.io.hold():
            on_click()

    widget = pn.widgets.Button(label=label, color=kind, **options)
    widget.on_click(click)
    return widget


def copy_button(rows: Callable[[], Rows], on_copy: Callable[[str], None], **options: Any) -> pn.widgets.Button:
    """A button that copies the rows at the time of the click; `on_copy` is called with the text."""
    return button("Copy table", lambda: on_copy("\n".join("\t".join(row) for row in rows())), **options)


def number_rows(title: str, numbers: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Rows of numbers at full precision, each with a title and its name."""
    return [(title, name, repr(value) if isinstance(value, float) else str(value)) for name, value in numbers.items()]


def flex_row(*views: pn.viewable.Viewable, justify: str = "start", align: str = "start", gap: str = "4px") -> pn.Column:
    """A row that is as high as its content.

    It is a Column with another flex direction, because a Row would be at least as wide as all its children together.

    Parameters
    ----------
    *views
        Children of the row.
    justify
        Horizontal position of the children, a CSS value of justify-content.
    align
        Vertical position of each child: start, center or end.
    gap
        Space between the children, a CSS length.
    """
    for view in views:
        view.align = align
    styles = {"flex-direction": "row", "flex-wrap": "wrap", "justify-content": justify, "gap": gap}
    return pn.Column(*views, styles=FULL_HEIGHT | styles, sizing_mode="stretch_width", margin=0)


def keep_place(*, shown: bool) -> dict[str, str]:
    """Styles of a part that keeps its space while it is hidden, so that the browser does not lay out the page again."""
    return {"visibility": "visible" if shown else "hidden"}


def bind[Bound: pn.widgets.Widget](widget: Bound, state: param.Parameterized, name: str) -> Bound:
    """Make a widget show an attribute of a state, and write to it."""

    def write(event: Any) -> None:
        # Held for the same reason as in `button`.
        with pn.io.hold():
            state.param.update({name: event.new})

    widget.value = getattr(state, name)
    widget.param.watch(write, "value")
    state.param.watch(lambda event: set_value(widget, event.new), name)
    return widget


def set_value(widget: pn.widgets.Widget, value: Any) -> None:
    """Show a value unless it is already shown: Panel would drop a choice of the browser that it has not handled yet."""
    if widget.value != value:
        widget.value = value
