"""Cancels the jobs of a page soon after its last connection is closed, long before its session expires."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any
from weakref import WeakKeyDictionary, WeakSet

CHECK_SECONDS = 0.25
"""Interval between two calls of `DisconnectMonitor.check`."""

_callbacks: WeakKeyDictionary[Any, Callable[[], None]] = WeakKeyDictionary()


def on_disconnect(document: Any, callback: Callable[[], None]) -> None:
    """Register a callback for the close of the last connection to a document; it is called at most once."""
    _callbacks[document] = callback


class DisconnectMonitor:
    """Detects sessions that have lost their last connection."""

    def __init__(self, sessions: Callable[[], Iterable[Any]]) -> None:
        self._sessions = sessions
        # A new session has no connection yet.
        self._connected: WeakSet[Any] = WeakSet()

    def check(self) -> None:
        """Call the callbacks of documents that have lost their last connection."""
        for session in list(self._sessions()):
            if session.connection_count:
                self._connected.add(session)
            elif session in self._connected:
                callback = _callbacks.pop(session.document, None)
                if callback is not None:
                    callback()
