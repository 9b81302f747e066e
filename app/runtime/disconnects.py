"""Pages that have lost their visitor: what was computed for them stops at once, long before their session ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any
from weakref import WeakKeyDictionary, WeakSet

LOOKED_AT_EVERY = 0.25
"""Seconds between two looks at all sessions."""

_leaving: WeakKeyDictionary[Any, Callable[[], None]] = WeakKeyDictionary()


def when_left(document: Any, stop: Callable[[], None]) -> None:
    """Have `stop` called when the last connection of a page's document is gone; at most once."""
    _leaving[document] = stop


class DisconnectMonitor:
    """Tells which pages have been left since the last look."""

    def __init__(self, sessions: Callable[[], Iterable[Any]]) -> None:
        self._sessions = sessions
        # A session without a connection may still wait for its first one.
        self._visited: WeakSet[Any] = WeakSet()

    def look(self) -> None:
        """Stop what is computed for pages that have been left."""
        for session in list(self._sessions()):
            if session.connection_count:
                self._visited.add(session)
            elif session in self._visited:
                stop = _leaving.pop(session.document, None)
                if stop is not None:
                    stop()
