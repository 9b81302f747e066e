"""Admission of pages and WebSockets. Both are refused if the server is full or stopping, or if their address has too many."""

from __future__ import annotations

import http.client
from html import escape
from typing import Any, NoReturn

from bokeh.protocol.exceptions import ProtocolError
from bokeh.util.token import get_session_id
from tornado.web import HTTPError

from app.runtime.health import refusal_reason
from app.runtime.process_state import process_state
from app.runtime.settings import variable_name
from app.runtime.visitors import network_of, visitor_of
from app.server.session_tokens import may_begin_session

LONGEST_LINK = 8192
"""Largest length of a request's path and query, in characters."""

RETRY_SECONDS = 10
"""Interval at which the browser requests a refused page again, in seconds."""

LONGEST_PAGE_WAIT = 30.0
"""Longest time that a page waits until it is made, in seconds; less than a proxy waits for an answer, see `deploy/nginx.conf`."""

RETRIED_STATUSES = (http.client.TOO_MANY_REQUESTS, http.client.SERVICE_UNAVAILABLE)
"""HTTP statuses of refusals after which the browser requests the page again."""


def admit(request: Any) -> None:
    """Refuse a request for a page that may not create a session.

    Raises
    ------
    tornado.web.HTTPError
        With status 414, 429 or 503, and a sentence that Tornado shows on the error page.
    """
    # `check_session` checks WebSockets.
    if request.path.endswith("/ws"):
        return
    if len(request.uri) > LONGEST_LINK:
        raise HTTPError(http.client.REQUEST_URI_TOO_LONG, reason=f"The address is longer than {LONGEST_LINK} characters.")
    network = network_of(request.remote_ip)
    _raise_for(http.client.SERVICE_UNAVAILABLE, refusal_reason(process_state(), network))
    page_count = sum(visitor_of(session.document) == network for session in process_state().sessions())
    _raise_for(http.client.TOO_MANY_REQUESTS, _address_reason(page_count))


def refuse_after_wait() -> NoReturn:
    """Refuse a page that has waited for `LONGEST_PAGE_WAIT`.

    Raises
    ------
    tornado.web.HTTPError
        With status 503.
    """
    reason = f"The server was busy for {LONGEST_PAGE_WAIT:g} s with other pages, of your address or of others."
    process_state().metrics.pages_refused.inc()
    raise HTTPError(http.client.SERVICE_UNAVAILABLE, reason=reason)


def refusal_page(sentence: str) -> str:
    """Return an error page with a sentence. The browser requests the refused page again after `RETRY_SECONDS`."""
    refresh = f"<meta http-equiv=refresh content={RETRY_SECONDS}>"
    head = f"<meta charset=utf-8><meta name=viewport content='width=device-width'>{refresh}<title>Escape Explorer</title>"
    body = f"<p>{escape(sentence)} This page tries again every {RETRY_SECONDS} s.</p>"
    return f"<!doctype html><html lang=en><head>{head}</head><body>{body}</body></html>"


def check_session(token: str, application_context: Any, address: str, application: Any) -> None:
    """Refuse a WebSocket unless its session is open. A recent page may begin a session if there is room.

    Parameters
    ----------
    token
        Token of the session, signed by this server.
    application_context
        Bokeh's application context, with the open sessions.
    address
        Address of the visitor.
    application
        The server's web application, with the time for which a token may begin a session.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        If the session has ended and the token is old, or the server is full or stopping. The message says which.
    """
    session_id = get_session_id(token)
    if any(session.id == session_id for session in application_context.sessions):
        return
    if not may_begin_session(application, token):
        raise ProtocolError(f"The session has ended, and its page is older than {application.session_token_expiration} s.")
    reason = refusal_reason(process_state(), network_of(address))
    if reason is not None:
        raise ProtocolError(reason)


def count_socket(address: str) -> None:
    """Count a new WebSocket of an address, or refuse it.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        If the address, or the server, has too many WebSockets. Then the count does not change.
    """
    sockets, network = process_state().sockets, network_of(address)
    most_sockets = process_state().settings.most_sessions
    reason = _address_reason(sockets[network])
    if reason is None and sockets.total() >= most_sockets:
        reason = f"There are {most_sockets} connections already."
    if reason is not None:
        raise ProtocolError(reason)
    sockets[network] += 1


def forget_socket(address: str) -> None:
    """Stop counting a WebSocket of an address."""
    sockets, network = process_state().sockets, network_of(address)
    sockets[network] -= 1
    if not sockets[network]:
        del sockets[network]


def _address_reason(count: int) -> str | None:
    """Return a sentence that refuses another page or WebSocket to an address with `count` of them; None if it may have more."""
    limit = process_state().settings.pages_per_address
    if count < limit:
        return None
    return f"Your address has {limit} open pages, the most that {variable_name('pages_per_address')} permits. Close some of them."


def _raise_for(status: int, reason: str | None) -> None:
    """Refuse a request with a status if there is a reason, and count the refusal."""
    if reason is not None:
        process_state().metrics.pages_refused.inc()
        raise HTTPError(status, reason=reason)
