"""Refuse requests for the page when the server is full or stopping."""

from __future__ import annotations

import http.client
from typing import Any

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
    # A WebSocket belongs to a page that was admitted, or to one that reconnects after a restart.
    if request.path.endswith("/ws"):
        return
    reason = refusal_reason(process_state())
    if reason is not None:
        process_state().metrics.pages_refused.inc()
        raise HTTPError(http.client.SERVICE_UNAVAILABLE, reason=reason)
