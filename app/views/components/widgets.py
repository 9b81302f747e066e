"""Widgets and rows of Panel with accessible names and with the classes of the stylesheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import panel as pn
import param
from bokeh.document import Document

from app.state.view_state import ViewState

COUNT_WHOLE = "Count the whole view"
"""Label of the buttons that remove the box."""

LOADED_MODULE = Path(__file__).with_name("loaded_module.js")
"""Script of components whose module, at their `address`, is loaded when they are first shown."""

FULL_HEIGHT = {"max-height": "none"}
"""Styles of a layout as high as its content. Bokeh would limit the height to the window, and the next parts would overlap."""

Rows = Iterable[Sequence[str]]
"""The rows of a table: the texts of their cells."""


class _NamedGroup:
    """Mixin that sets the role and the accessible name (the label) of the widget's element. Bokeh sets neither."""

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
    """Checkboxes drawn as switches; `value` lists the options that are on."""

    def __init__(self, **options: Any) -> None:
        super().__init__(inline=True, css_classes=["switches"], **options)


def switch(
    title: str,
    option: str,
    state: ViewState,
    name: str,
    is_on: Callable[[Any], bool],
    turn: Callable[[bool], object],
    **options: Any,
) -> Switches:
    """Return a switch that follows a field of the view state.

    Parameters
    ----------
    title
        Accessible name of the group that contains the switch.
    option
        Label of the switch.
    state, name
        View state, and the name of the field.
    is_on
        Returns whether the switch is on for a value of the field.
    turn
        Handles a click; the argument is whether the switch is on.
    **options
        Options of `Switches`.
    """
    control = Switches(label=title, options=[option], **options)

    def take(event: Any) -> None:
        on = bool(event.new)
        if on != is_on(getattr(state, name)):
            # `hold` provides the session's lock, as in `button`.
            with pn.io.hold():
                turn(on)

    state.follow(lambda value: control.param.update(value=[option] if is_on(value) else []), name)
    control.param.watch(take, "value")
    return control


def button(label: str, on_click: Callable[[], Any], *, kind: str = "default", **options: Any) -> pn.widgets.Button:
    """Return a button; `kind` is "default", "primary" (the main action of a section) or "light" (without a frame)."""

    def click(event: Any) -> None:
        # Panel runs callbacks of widgets without the session's lock, which changes of Bokeh models need. `hold` provides it.
        with pn.io.hold():
            on_click()

    widget = pn.widgets.Button(label=label, color=kind, **options)
    widget.on_click(click)
    return widget


def copy_button(rows: Callable[[], Rows], on_copy: Callable[[str], None], **options: Any) -> pn.widgets.Button:
    """Return a button that passes the present rows to `on_copy`, as tab-separated text."""
    return button("Copy table", lambda: on_copy("\n".join("\t".join(row) for row in rows())), **options)


def number_rows(title: str, numbers: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return a row for each number: a title, the name of the number, and its value at full precision."""
    return [(title, name, repr(value) if isinstance(value, float) else str(value)) for name, value in numbers.items()]


def flex_row(*views: pn.viewable.Viewable, justify: str = "start", align: str = "start", gap: str = "4px") -> pn.Column:
    """Return a row as high as its content.

    The row is a `Column` with another flex direction, because a `Row` would not become narrower than its children together.

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
    """Return styles that show or hide a part but keep its space. The browser then does not lay out the page again."""
    return {"visibility": "visible" if shown else "hidden"}


def bind[Bound: pn.widgets.Widget](widget: Bound, state: param.Parameterized, name: str) -> Bound:
    """Connect the value of a widget with a parameter of a state: each follows the other."""

    def write(event: Any) -> None:
        # `hold` provides the session's lock, as in `button`.
        with pn.io.hold():
            state.param.update({name: event.new})

    widget.value = getattr(state, name)
    widget.param.watch(write, "value")
    state.param.watch(lambda event: set_value(widget, event.new), name)
    return widget


def set_value(widget: pn.widgets.Widget, value: Any) -> None:
    """Set the value of a widget if it differs. Setting an equal value would drop a choice that the browser has just sent."""
    if widget.value != value:
        widget.value = value
