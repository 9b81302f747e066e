"""Refuse requests for the page when the server is full or stopping."""

from __future__ import annotations

import http.client
from typing import Any

from bokeh.protocol.exceptions import ProtocolError
from bokeh.util.token import get_session_id
from tornado.web import HTTPError

from app.runtime.health import refusal_reason
from app.runtime.process_state import process_state


def admit(request: Any) -> None:
    """Return for requests that may create a session; refuse all others.

    Raises
    ------
    tornado.web.HTTPError
        Status 503 with a sentence as its reason, which Tornado shows on the error page.
    """
    # `check_session` admits a WebSocket.
    if request.path.endswith("/ws"):
        return
    reason = refusal_reason(process_state())
    if reason is not None:
        process_state().metrics.pages_refused.inc()
        raise HTTPError(http.client.SERVICE_UNAVAILABLE, reason=reason)


def check_session(token: str | None, application_context: Any) -> None:
    """Return for WebSockets of open sessions, and for others, such as those that reconnect after a restart, while there is room.

    Tokens are not signed: without this check, anyone could open sessions beyond their maximum number.

    Raises
    ------
    bokeh.protocol.exceptions.ProtocolError
        When the server is full or stopping, with the reason, or when the token is missing.
    ValueError, KeyError
        When the token is invalid.
    """
    if token is None:
        raise ProtocolError("no token")
    session = get_session_id(token)
    if any(each.id == session for each in application_context.sessions):
        return
    reason = refusal_reason(process_state())
    if reason is not None:
        raise ProtocolError(reason)
