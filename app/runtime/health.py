"""Whether the server should be sent more visitors."""

from __future__ import annotations

from app.runtime.memory import resident_bytes
from app.runtime.process_state import ProcessState
from app.runtime.settings import variable_of


def why_not_ready(site: ProcessState) -> str | None:
    """What stands against more visitors, in one sentence; None when nothing does."""
    if site.stopping.is_set():
        return "The server is stopping."
    if site.failed.is_set():
        return "The integrators could not be compiled; the log says why."
    if not site.prepared.is_set():
        return "The integrators are being compiled."
    # Where the system does not tell, the ceiling is no objection.
    ceiling, memory = site.settings.memory_ceiling, resident_bytes() or 0
    if ceiling and memory > ceiling:
        return f"The server holds {memory} bytes, above {variable_of('memory_ceiling')}={ceiling}."
    return _why_full(site)


def why_no_entry(site: ProcessState) -> str | None:
    """What stands against one more session, in one sentence; None when nothing does.

    Less than for readiness: who asks while the integrators are compiled may wait on the page.
    """
    if site.stopping.is_set():
        return "The server is stopping. Reload this page in a minute."
    return _why_full(site)


def _why_full(site: ProcessState) -> str | None:
    most = site.settings.most_sessions
    if site.count_sessions() < most:
        return None
    return f"All {most} places are taken. Reload this page in a minute."
