"""Refuse pages and WebSockets when the server is full or stopping, or when one address has its share of them."""

from __future__ import annotations

import http.client
import ipaddress
from typing import Any

from bokeh.protocol.exceptions import ProtocolError
from bokeh.util.token import get_session_id
from tornado.web import HTTPError

from app.runtime.health import refusal_reason
from app.runtime.process_state import process_state
from app.runtime.settings import variable_name

LONGEST_LINK = 8192
"""Most characters of the address of a page."""


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
    _refuse(http.client.SERVICE_UNAVAILABLE, refusal_reason(process_state()))
    address = network_of(request.remote_ip)
    pages = sum(network_of(_request_of(session).remote_ip) == address for session in process_state().sessions())
    _refuse(http.client.TOO_MANY_REQUESTS, _share_reason(pages))


def check_session(token: str, application_context: Any) -> None:
    """Return for WebSockets of open sessions, and for others, such as those that reconnect after a pause, while there is room.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        When the server is full or stopping, with the reason.
    """
    session = get_session_id(token)
    if any(each.id == session for each in application_context.sessions):
        return
    reason = refusal_reason(process_state())
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
        reason = f"There are {most} connections already. Reload this page in a minute."
    if reason is not None:
        raise ProtocolError(reason)
    sockets[network_of(address)] += 1


def forget_socket(address: str) -> None:
    """Stop counting a WebSocket."""
    sockets, network = process_state().sockets, network_of(address)
    sockets[network] -= 1
    if not sockets[network]:
        del sockets[network]


def network_of(address: str) -> str:
    """Return what is limited together: an IPv4 address, or the 64 bits of an IPv6 address that belong to a network."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    return address if parsed.version == 4 else str(ipaddress.ip_network((parsed, 64), strict=False))


def _request_of(session: Any) -> Any:
    return session.document.session_context.request


def _share_reason(count: int) -> str | None:
    most = process_state().settings.pages_per_address
    if count < most:
        return None
    return f"Your address has {most} open pages, the most that {variable_name('pages_per_address')} permits. Close some of them."


def _refuse(status: int, reason: str | None) -> None:
    if reason is not None:
        process_state().metrics.pages_refused.inc()
        raise HTTPError(status, reason=reason)
