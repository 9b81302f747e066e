"""Readiness of the server, and admission of new sessions."""

from __future__ import annotations

import psutil

from app.runtime.process_state import ProcessState
from app.runtime.settings import variable_name


def resident_bytes() -> int:
    """Return the resident memory of the process in bytes."""
    return int(psutil.Process().memory_info().rss)


def not_ready_reason(state: ProcessState) -> str | None:
    """Return a sentence that says why a load balancer should send no more visitors; None when the server is ready."""
    if state.stopping.is_set():
        return "The server is stopping."
    if state.kernels_failed.is_set():
        return "The integrators could not be compiled; the log says why."
    if not state.kernels_ready.is_set():
        return "The integrators are being compiled."
    ceiling, memory = state.settings.memory_ceiling, resident_bytes()
    if ceiling and memory > ceiling:
        return f"The server holds {memory} bytes, above {variable_name('memory_ceiling')}={ceiling}."
    return _full_reason(state)


def refusal_reason(state: ProcessState) -> str | None:
    """Return a sentence that says why no session can be created; None when one can.

    Weaker than readiness: sessions are created while the integrators are compiled, and wait on the page.
    """
    if state.stopping.is_set():
        return "The server is stopping. Reload this page in a minute."
    return _full_reason(state)


def _full_reason(state: ProcessState) -> str | None:
    limit, sessions = state.settings.most_sessions, list(state.sessions())
    if len(sessions) >= limit:
        return f"All {limit} places are taken. Reload this page in a minute."
    # The only visitor may reload the page, whatever delays it.
    if state.overload.is_overloaded() and any(session.connection_count for session in sessions):
        return "The server is busy with the pages that are open. Reload this page in a minute."
    return None
