"""Which pages and WebSockets are admitted."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from bokeh.protocol.exceptions import ProtocolError
from bokeh.util.token import generate_jwt_token, generate_session_id
from tornado.web import HTTPError

from app.runtime import process_state as process_state_module
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.admission import (
    LONGEST_LINK,
    RETRY_SECONDS,
    admit,
    check_session,
    count_socket,
    forget_socket,
    refusal_page,
)

TOKEN = generate_jwt_token(generate_session_id())


@pytest.fixture
def state(monkeypatch: pytest.MonkeyPatch) -> ProcessState:
    """A server with three places, two of them for one address."""
    settings = Settings(most_sessions=3, pages_per_address=2)
    monkeypatch.setattr(process_state_module, "_started", state := ProcessState(settings))
    return state


def session_of(address: str) -> Any:
    context = SimpleNamespace(request=SimpleNamespace(remote_ip=address))
    return SimpleNamespace(document=SimpleNamespace(session_context=context))


def ask(address: str, uri: str = "/app") -> tuple[int, str]:
    """Status and reason of a request for a page."""
    try:
        admit(SimpleNamespace(path=uri.partition("?")[0], uri=uri, remote_ip=address))
    except HTTPError as refusal:
        return refusal.status_code, str(refusal.reason)
    return 200, ""


def test_pages_of_one_address_are_limited(state: ProcessState) -> None:
    state.sessions = lambda: [session_of("192.0.2.1")] * 2
    status, reason = ask("192.0.2.1")
    assert status == 429
    assert "2 open pages" in reason
    assert ask("192.0.2.2")[0] == 200


def test_pages_of_all_addresses_are_limited(state: ProcessState) -> None:
    state.sessions = lambda: [session_of(f"192.0.2.{number}") for number in range(3)]
    assert ask("192.0.2.9") == (503, "All 3 places are taken.")


def test_websockets_are_not_pages(state: ProcessState) -> None:
    state.sessions = lambda: [session_of("192.0.2.1")] * 2
    assert ask("192.0.2.1", "/app/ws")[0] == 200


def test_the_only_visitor_of_a_busy_server_may_reload_the_page(state: ProcessState) -> None:
    state.overload.add(1000.0)
    state.sessions = lambda: [session_of("192.0.2.1")]
    count_socket("192.0.2.1")
    assert ask("192.0.2.1")[0] == 200
    assert ask("192.0.2.2")[0] == 503
    context = SimpleNamespace(sessions=[])
    check_session(TOKEN, context, "192.0.2.1")
    with pytest.raises(ProtocolError, match="is busy"):
        check_session(TOKEN, context, "192.0.2.2")


def test_a_refused_page_asks_again_by_itself() -> None:
    page = refusal_page("All <3> places are taken.")
    assert f"<meta http-equiv=refresh content={RETRY_SECONDS}>" in page
    assert "All &lt;3&gt; places are taken." in page


@pytest.mark.parametrize(("length", "status"), [(LONGEST_LINK, 200), (LONGEST_LINK + 1, 414)])
@pytest.mark.usefixtures("state")
def test_long_links_are_refused(length: int, status: int) -> None:
    assert ask("192.0.2.1", "/app?V=".ljust(length, "x"))[0] == status


def test_websockets_of_one_address_are_limited(state: ProcessState) -> None:
    for _ in range(2):
        count_socket("192.0.2.1")
    with pytest.raises(ProtocolError, match="2 open pages"):
        count_socket("192.0.2.1")
    assert state.sockets == {"192.0.2.1": 2}
    forget_socket("192.0.2.1")
    count_socket("192.0.2.1")


@pytest.mark.usefixtures("state")
def test_websockets_of_all_addresses_are_limited() -> None:
    for number in range(3):
        count_socket(f"192.0.2.{number}")
    with pytest.raises(ProtocolError, match="3 connections"):
        count_socket("192.0.2.9")


def test_addresses_without_websockets_are_forgotten(state: ProcessState) -> None:
    count_socket("192.0.2.1")
    forget_socket("192.0.2.1")
    assert state.sockets == {}
