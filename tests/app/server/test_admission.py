"""Pages and WebSockets are admitted within the limits of addresses and tokens."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from bokeh.application import Application
from bokeh.protocol.exceptions import ProtocolError
from bokeh.server.tornado import BokehTornado
from bokeh.util.token import get_session_id
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine
from tornado.web import HTTPError

from app.runtime.process_state import ProcessState
from app.server.admission import (
    LONGEST_LINK,
    admit,
    check_session,
    count_socket,
)
from app.server.session_tokens import issue_token

APPLICATION = BokehTornado({"/app": Application()})


@pytest.fixture
def state(start_state: Callable[..., ProcessState]) -> ProcessState:
    """Return the state of a server with three places, at most two of them for one address."""
    return start_state(most_sessions=3, pages_per_address=2)


class OpenedDocument:
    """The part of a document that identifies its visitor."""

    def __init__(self, address: str) -> None:
        self.session_context = SimpleNamespace(request=SimpleNamespace(remote_ip=address))


def session_of(address: str) -> Any:
    return SimpleNamespace(document=OpenedDocument(address), connection_count=1)


def new_token(age: float) -> str:
    """Return a token that was issued some seconds ago."""
    request = HTTPServerRequest(
        start_line=RequestStartLine("GET", "/app", "HTTP/1.1"), headers=HTTPHeaders({"Host": "localhost"})
    )
    return issue_token(APPLICATION, request, {}, clock=lambda: time.monotonic() - age)


def ask(address: str, uri: str = "/app") -> tuple[int, str]:
    """Return the status and reason of a request for a page."""
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


def test_websockets_are_not_pages(state: ProcessState) -> None:
    state.sessions = lambda: [session_of("192.0.2.1")] * 2
    assert ask("192.0.2.1", "/app/ws")[0] == 200


def test_the_only_visitor_of_a_busy_server_may_reload_the_page(state: ProcessState) -> None:
    state.capacity.cores = 0.01
    state.sessions = lambda: [session_of("192.0.2.1")]
    count_socket("192.0.2.1")
    assert ask("192.0.2.1")[0] == 200
    assert ask("192.0.2.2")[0] == 503
    context, token = SimpleNamespace(sessions=[]), new_token(age=0.0)
    check_session(token, context, "192.0.2.1", APPLICATION)
    with pytest.raises(ProtocolError, match="is busy"):
        check_session(token, context, "192.0.2.2", APPLICATION)


@pytest.mark.usefixtures("state")
def test_an_old_token_opens_only_its_open_session() -> None:
    token = new_token(age=300.0)
    check_session(token, SimpleNamespace(sessions=[SimpleNamespace(id=get_session_id(token))]), "192.0.2.1", APPLICATION)
    with pytest.raises(ProtocolError, match="ended"):
        check_session(token, SimpleNamespace(sessions=[]), "192.0.2.1", APPLICATION)


@pytest.mark.parametrize(("length", "status"), [(LONGEST_LINK, 200), (LONGEST_LINK + 1, 414)])
@pytest.mark.usefixtures("state")
def test_long_links_are_refused(length: int, status: int) -> None:
    assert ask("192.0.2.1", "/app?V=".ljust(length, "x"))[0] == status
