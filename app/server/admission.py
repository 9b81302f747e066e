"""Refuse pages and WebSockets when the server is full or stopping, or an address has its share of them."""

from __future__ import annotations

import http.client
from html import escape
from typing import Any

from bokeh.protocol.exceptions import ProtocolError
from bokeh.util.token import get_session_id
from tornado.web import HTTPError

from app.runtime.health import refusal_reason
from app.runtime.process_state import process_state
from app.runtime.settings import variable_name
from app.runtime.visitors import network_of, visitor_of
from app.server.session_tokens import may_begin_session

LONGEST_LINK = 8192
"""Largest length of the address of a page, in characters."""

RETRY_SECONDS = 10
"""Interval at which the browser asks again for a refused page, in seconds."""

RETRIED = (http.client.TOO_MANY_REQUESTS, http.client.SERVICE_UNAVAILABLE)
"""Statuses of refused pages that may be served later."""


def admit(request: Any) -> None:
    """Return for requests that may create a session; refuse all others.

    Raises
    ------
    tornado.web.HTTPError
        Status 414, 429 or 503 with a sentence as its reason, which Tornado shows on the error page.
    """
    # `check_session` admits a WebSocket.
    if request.path.endswith("/ws"):
        return
    if len(request.uri) > LONGEST_LINK:
        raise HTTPError(http.client.REQUEST_URI_TOO_LONG, reason=f"The address is longer than {LONGEST_LINK} characters.")
    network = network_of(request.remote_ip)
    _refuse(http.client.SERVICE_UNAVAILABLE, refusal_reason(process_state(), network))
    pages = sum(visitor_of(session.document) == network for session in process_state().sessions())
    _refuse(http.client.TOO_MANY_REQUESTS, _share_reason(pages))


def refusal_page(sentence: str) -> str:
    """Return a page that says why a page is refused, and asks for the page again after `RETRY_SECONDS`."""
    head = (
        f"<meta charset=utf-8><meta name=viewport content='width=device-width'><meta http-equiv=refresh content={RETRY_SECONDS}>"
    )
    body = f"<p>{escape(sentence)} This page tries again every {RETRY_SECONDS} s.</p>"
    return f"<!doctype html><html lang=en><head>{head}<title>Escape Explorer</title></head><body>{body}</body></html>"


def check_session(token: str, application_context: Any, address: str, application: Any) -> None:
    """Return for WebSockets of open sessions. For those of recent pages, return while there is room.

    Parameters
    ----------
    token
        Signed by this server.
    application_context
        Bokeh's, with the open sessions.
    address
        Of the visitor.
    application
        The server's web application, with the time within which a token may begin a session.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        When the session has ended and the token is old, or when the server is full or stopping, with the reason.
    """
    session = get_session_id(token)
    if any(each.id == session for each in application_context.sessions):
        return
    if not may_begin_session(application, token):
        raise ProtocolError(f"The session has ended, and its page is older than {application.session_token_expiration} s.")
    reason = refusal_reason(process_state(), network_of(address))
    if reason is not None:
        raise ProtocolError(reason)


def count_socket(address: str) -> None:
    """Count a new WebSocket of an address.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        When the address, or the server, has too many; nothing is counted then.
    """
    sockets, most = process_state().sockets, process_state().settings.most_sessions
    reason = _share_reason(sockets[network_of(address)])
    if reason is None and sockets.total() >= most:
        reason = f"There are {most} connections already."
    if reason is not None:
        raise ProtocolError(reason)
    sockets[network_of(address)] += 1


def forget_socket(address: str) -> None:
    """Stop counting a WebSocket."""
    sockets, network = process_state().sockets, network_of(address)
    sockets[network] -= 1
    if not sockets[network]:
        del sockets[network]


def _share_reason(count: int) -> str | None:
    most = process_state().settings.pages_per_address
    if count < most:
        return None
    return f"Your address has {most} open pages, the most that {variable_name('pages_per_address')} permits. Close some of them."


def _refuse(status: int, reason: str | None) -> None:
    if reason is not None:
        process_state().metrics.pages_refused.inc()
        raise HTTPError(status, reason=reason)
