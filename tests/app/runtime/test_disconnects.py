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


@pytest.fixture
def monitor(session: Session) -> DisconnectMonitor:
    return DisconnectMonitor(lambda: [session])


def test_new_session_without_connection_is_not_disconnected(session: Session, monitor: DisconnectMonitor) -> None:
    monitor.check()
    assert session.disconnects == 0


def test_callback_is_called_once_after_last_connection(session: Session, monitor: DisconnectMonitor) -> None:
    for connections in (1, 2, 1):
        session.connection_count = connections
        monitor.check()
    assert session.disconnects == 0
    session.connection_count = 0
    monitor.check()
    monitor.check()
    assert session.disconnects == 1


def test_other_sessions_are_not_affected(session: Session) -> None:
    other = Session()
    monitor = DisconnectMonitor(lambda: [session, other])
    session.connection_count = other.connection_count = 1
    monitor.check()
    session.connection_count = 0
    monitor.check()
    assert (session.disconnects, other.disconnects) == (1, 0)


def test_session_without_callback_is_ignored(session: Session, monitor: DisconnectMonitor) -> None:
    session.document = Document()
    session.connection_count = 1
    monitor.check()
    session.connection_count = 0
    monitor.check()
    assert session.disconnects == 0


def test_monitor_keeps_no_reference_to_ended_sessions(session: Session) -> None:
    sessions = [session, Session()]
    monitor = DisconnectMonitor(lambda: sessions)
    sessions[1].connection_count = 1
    monitor.check()
    ended = weakref.ref(sessions.pop())
    gc.collect()
    assert ended() is None
