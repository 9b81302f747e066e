"""Parts of the page that are built when they are first shown: stacks, folds and drawers, and parts that are built one by one."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

import panel as pn

from app.views.components.texts import TextPane
from app.views.components.widgets import FULL_HEIGHT, button

Build = Callable[[], Sequence[pn.viewable.Viewable]]
"""Makes the parts of a content, or some of the parts."""

Later = Callable[[Callable[[], None]], Callable[[], None]]
"""Wraps a function so that it runs in a later iteration of the event loop."""


def at_once(function: Callable[[], None]) -> Callable[[], None]:
    """Return the function itself, so that it runs at once."""
    return function


class Stack:
    """A column that shows one of several contents, or none. The other contents are not on the page.

    Parameters
    ----------
    builders
        Functions that make the parts of each content, by name. They are called when the content is first shown.
    css_class
        CSS class of the column.
    head
        Parts that stay above the content.
    later
        Wraps a function to run in a later iteration of the event loop. All parts of a content but the first are made later.
    """

    def __init__(
        self,
        builders: Mapping[str, Sequence[Build]],
        css_class: str,
        head: Sequence[pn.viewable.Viewable] = (),
        later: Later = at_once,
    ) -> None:
        self._builders, self._head, self._later = builders, head, later
        self._contents: dict[str, list[pn.viewable.Viewable]] = {}
        self._column = pn.Column(
            *head, sizing_mode="stretch_width", styles=FULL_HEIGHT, visible=bool(head), margin=0, css_classes=[css_class]
        )
        self.shown: str | None = None

    def layout(self) -> pn.viewable.Viewable:
        """Return the column."""
        return self._column

    def show(self, name: str | None) -> None:
        """Replace the present content by another; None shows no content."""
        self.shown = name
        if name is not None and name not in self._contents:
            build_first, *later_builders = self._builders[name]
            self._contents[name] = content = [*build_first()]
            InTurns(later_builders, partial(self._add, content), self._later).begin()
        self._arrange()

    def _add(self, content: list[pn.viewable.Viewable], parts: Sequence[pn.viewable.Viewable]) -> None:
        content += parts
        self._arrange()

    def _arrange(self) -> None:
        parts = [*self._head, *(self._contents[self.shown] if self.shown is not None else [])]
        if parts != self._column.objects:
            self._column.param.update(objects=parts, visible=bool(parts))

    def rebuild(self) -> None:
        """Build the contents again: the present content now, other contents when they are next shown."""
        self._contents.clear()
        self.show(self.shown)

    def toggle(self, name: str) -> None:
        """Show a content, or hide it if it is shown."""
        self.show(None if self.shown == name else name)


class Fold(Stack):
    """A column with one content that opens and closes, under a button with its title."""

    def __init__(self, title: str, build: Build, *, is_open: bool = False) -> None:
        super().__init__({"content": [build]}, "fold")
        self._title = title
        self.button = button("", lambda: self.toggle("content"), kind="light", margin=0, css_classes=["fold-title"])
        self.set_open(is_open)

    @property
    def is_open(self) -> bool:
        """Whether the content is on the page."""
        return self.shown is not None

    def set_open(self, is_open: bool) -> None:
        """Show or hide the content."""
        self.show("content" if is_open else None)

    def parts(self) -> list[pn.viewable.Viewable]:
        """Return the button and the column."""
        return [self.button, self.layout()]

    def show(self, name: str | None) -> None:
        """Show or hide the content."""
        super().show(name)
        self.button.label = f"{'▾' if self.is_open else '▸'} {self._title}"


class Drawers(Stack):
    """Titled sections over the controls, with the buttons that open them. At most one section is open.

    Parameters
    ----------
    drawers
        Label of the button, title, and functions that make the parts of each drawer, by name. The label is empty if the button
        is elsewhere.
    on_toggle
        Called when a drawer opens or closes. The argument tells whether a drawer is open now.
    later
        Wraps a function to run in a later iteration of the event loop. The content of a drawer is made later than its title.
    """

    def __init__(
        self,
        drawers: Mapping[str, tuple[str, str, Sequence[Build]]],
        on_toggle: Callable[[bool], None] = lambda is_open: None,
        later: Later = at_once,
    ) -> None:
        self._on_toggle = on_toggle
        builders: dict[str, list[Build]] = {
            name: [partial(self._make_head, title), *parts] for name, (_, title, parts) in drawers.items()
        }
        super().__init__(builders, "drawer", later=later)
        options = {label: name for name, (label, _, _) in drawers.items() if label}
        self.buttons = pn.widgets.CheckButtonGroup(options=options, color="light", margin=0, css_classes=["solid"])
        self.buttons.param.watch(self._press, "value")

    def show(self, name: str | None) -> None:
        """Open a drawer and close any other drawer; None closes all drawers."""
        previous_name = self.shown
        # Send all changes in one message. Between two messages, the user could press a button while the old button is marked.
        with pn.io.hold():
            super().show(name)
            self.buttons.value = self._marked_buttons()
            if name != previous_name:
                self._on_toggle(name is not None)

    def _press(self, event: Any) -> None:
        """Open the drawer of a pressed button, or close it. Other changes of the marked buttons come from `show`."""
        if event.new != self._marked_buttons():
            pressed = [name for name in event.new if name != self.shown]
            self.show(pressed[-1] if pressed else None)

    def _marked_buttons(self) -> list[str]:
        """Return the buttons to mark: the button of the open drawer, if it has one."""
        return [name for name in self.buttons.options.values() if name == self.shown]

    def _make_head(self, title: str) -> list[pn.viewable.Viewable]:
        head = TextPane(f"<h2>{title}</h2>", sizing_mode="stretch_width", margin=0, align="center")
        close = button("Close", lambda: self.show(None), kind="light", margin=0)
        return [pn.Row(head, close, sizing_mode="stretch_width", margin=0)]


class InTurns:
    """Makes parts one after another. Between two parts, the server can serve other pages.

    Parameters
    ----------
    builders
        Functions that make the parts.
    add
        Adds a new part to the page.
    later
        Wraps a function to run in a later iteration of the event loop.
    """

    def __init__(self, builders: Iterable[Build], add: Callable[[Sequence[pn.viewable.Viewable]], None], later: Later) -> None:
        self._waiting_builders, self._add = deque(builders), add
        self._continue = later(self._make_next)

    def begin(self) -> None:
        """Make the parts that do not exist yet."""
        if self._waiting_builders:
            self._continue()

    def _make_next(self) -> None:
        if self._waiting_builders:
            build = self._waiting_builders.popleft()
            try:
                self._add(build())
            finally:
                # An error in one part does not prevent the others.
                self.begin()
