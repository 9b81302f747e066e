"""Who gets a session: everybody, until the server is full or stopping."""

from __future__ import annotations

import http.client
from typing import Any

from tornado.web import HTTPError

from app.runtime.health import why_no_entry
from app.runtime.metrics import process_metrics
from app.runtime.process_state import process_state


def admit(request: Any) -> None:
    """Let a request for the page pass, or answer it with status 503 and a sentence.

    Raises
    ------
    tornado.web.HTTPError
        With the sentence as its reason, which Tornado shows as the page.
    """
    # A connection belongs to a page that was let in, or to one that comes back after a restart.
    if request.path.endswith("/ws"):
        return
    reason = why_no_entry(process_state())
    if reason is not None:
        process_metrics().refused.inc()
        raise HTTPError(http.client.SERVICE_UNAVAILABLE, reason=reason)
