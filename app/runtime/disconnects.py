"""Callbacks for pages that lose their last connection. They can cancel jobs long before the session expires."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any
from weakref import WeakKeyDictionary, WeakSet

CHECK_SECONDS = 0.25
"""Interval between two calls of `DisconnectMonitor.check`, in seconds."""

_callbacks: WeakKeyDictionary[Any, Callable[[], None]] = WeakKeyDictionary()


def on_disconnect(document: Any, callback: Callable[[], None]) -> None:
    """Register the callback of a document, which is called once, after the last connection of its session is closed."""
    _callbacks[document] = callback


class DisconnectMonitor:
    """Calls the callback of each document whose session has lost its last connection."""

    def __init__(self, sessions: Callable[[], Iterable[Any]]) -> None:
        self._sessions = sessions
        # Sessions that have had a connection. A new session has none yet.
        self._once_connected: WeakSet[Any] = WeakSet()

    def check(self) -> None:
        """Call the callbacks of documents that have lost their last connection."""
        for session in list(self._sessions()):
            if session.connection_count:
                self._once_connected.add(session)
            elif session in self._once_connected:
                callback = _callbacks.pop(session.document, None)
                if callback is not None:
                    callback()
