"""Parts of the page that are made one by one, each in its own iteration of the event loop."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence

import panel as pn

Later = Callable[[Callable[[], None]], Callable[[], None]]
"""Wraps a function so that it runs in a later iteration of the event loop."""


def at_once(function: Callable[[], None]) -> Callable[[], None]:
    """Return the function itself, which is then not called later."""
    return function


Make = Callable[[], Sequence[pn.viewable.Viewable]]
"""Makes a part of the page."""


class InTurns:
    """Makes parts when they are needed. Between two parts, the server can serve other pages.

    Parameters
    ----------
    makes
        Functions that make the parts.
    add
        Adds a new part to the page.
    later
        Wraps a function to run in a later iteration of the event loop.
    """

    def __init__(self, makes: Iterable[Make], add: Callable[[Sequence[pn.viewable.Viewable]], None], later: Later) -> None:
        self._missing, self._add = deque(makes), add
        self._continue = later(self._make_next)

    def begin(self) -> None:
        """Make the parts that do not exist yet."""
        if self._missing:
            self._continue()

    def _make_next(self) -> None:
        if self._missing:
            self._add(self._missing.popleft()())
            self.begin()
