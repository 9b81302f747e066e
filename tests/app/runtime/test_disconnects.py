"""Jobs of a page are cancelled when its last connection closes."""

from __future__ import annotations

import gc
import weakref
from functools import partial

import pytest

from app.runtime.disconnects import DisconnectMonitor, on_disconnect


class Document:
    """Stand-in for a Bokeh document."""


class Session:
    """Stand-in for a Bokeh session; counts its disconnect callbacks."""

    def __init__(self) -> None:
        self.document = Document()
        self.connection_count = 0
        self._called: list[bool] = []
        on_disconnect(self.document, partial(self._called.append, True))

    @property
    def disconnects(self) -> int:
        return len(self._called)


@pytest.fixture
def session() -> Session:
    return Session()


def test_callback_is_called_once_after_the_last_connection(session: Session) -> None:
    other, silent = Session(), Session()
    silent.document = Document()
    monitor = DisconnectMonitor(lambda: [session, other, silent])
    for connections in (0, 1, 2, 1):
        session.connection_count = other.connection_count = silent.connection_count = connections
        monitor.check()
    assert session.disconnects == 0
    session.connection_count = silent.connection_count = 0
    monitor.check()
    monitor.check()
    assert (session.disconnects, other.disconnects) == (1, 0)


def test_monitor_keeps_no_reference_to_ended_sessions(session: Session) -> None:
    sessions = [session, Session()]
    monitor = DisconnectMonitor(lambda: sessions)
    sessions[1].connection_count = 1
    monitor.check()
    ended = weakref.ref(sessions.pop())
    gc.collect()
    assert ended() is None
