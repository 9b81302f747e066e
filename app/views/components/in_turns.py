"""Parts of the page that are made one after the other, each in its own iteration of the event loop."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence

import panel as pn

Later = Callable[[Callable[[], None]], Callable[[], None]]
"""Wraps a function so that it runs in a later iteration of the event loop."""

Make = Callable[[], Sequence[pn.viewable.Viewable]]


class InTurns:
    """Makes parts once they are needed; between two parts, other pages are served.

    Parameters
    ----------
    makes
        Functions that make the parts.
    add
        Called with each new part.
    later
        Wraps functions of the session.
    """

    def __init__(self, makes: Iterable[Make], add: Callable[[Sequence[pn.viewable.Viewable]], None], later: Later) -> None:
        self._left, self._add = deque(makes), add
        self._continue = later(self._make_next)

    def begin(self) -> None:
        """Make the parts that do not exist yet."""
        if self._left:
            self._continue()

    def _make_next(self) -> None:
        if self._left:
            self._add(self._left.popleft()())
            self.begin()
