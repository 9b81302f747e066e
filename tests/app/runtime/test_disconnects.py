"""What is computed for a page stops when its last connection is gone."""

from __future__ import annotations

import gc
import weakref
from functools import partial

import pytest

from app.runtime.disconnects import DisconnectMonitor, when_left


class Document:
    """Stands for a page's document."""


class Session:
    """Stands for a session of Bokeh's server; what its page asked for is stopped as often as `stopped` is long."""

    def __init__(self) -> None:
        self.document = Document()
        self.connection_count = 0
        self.stopped: list[bool] = []
        when_left(self.document, partial(self.stopped.append, True))

    @property
    def stops(self) -> int:
        return len(self.stopped)


@pytest.fixture
def session() -> Session:
    return Session()


@pytest.fixture
def pages(session: Session) -> DisconnectMonitor:
    return DisconnectMonitor(lambda: [session])


def test_a_page_that_waits_for_its_first_connection_has_not_been_left(session: Session, pages: DisconnectMonitor) -> None:
    pages.look()
    assert session.stops == 0


def test_a_page_stops_once_when_its_last_connection_is_gone(session: Session, pages: DisconnectMonitor) -> None:
    for connections in (1, 2, 1):
        session.connection_count = connections
        pages.look()
    assert session.stops == 0
    session.connection_count = 0
    pages.look()
    pages.look()
    assert session.stops == 1


def test_a_page_that_was_left_stops_no_other(session: Session) -> None:
    other = Session()
    pages = DisconnectMonitor(lambda: [session, other])
    session.connection_count = other.connection_count = 1
    pages.look()
    session.connection_count = 0
    pages.look()
    assert (session.stops, other.stops) == (1, 0)


def test_a_session_whose_page_asked_for_nothing_is_passed_over(session: Session, pages: DisconnectMonitor) -> None:
    session.document = Document()
    session.connection_count = 1
    pages.look()
    session.connection_count = 0
    pages.look()
    assert session.stops == 0


def test_nothing_keeps_a_session_that_is_over(session: Session) -> None:
    sessions = [session, Session()]
    pages = DisconnectMonitor(lambda: sessions)
    sessions[1].connection_count = 1
    pages.look()
    over = weakref.ref(sessions.pop())
    gc.collect()
    assert over() is None
