"""Error messages for the page; details go to the log."""

from __future__ import annotations

import logging

log = logging.getLogger(__name__)

WINDOW_UNKNOWN = "The window is not known before the integrator is compiled."


def sentence(error: Exception) -> str:
    """Message of a ValueError, which is written for users; for other errors a reference to the log, where they are logged."""
    if isinstance(error, ValueError):
        return str(error)
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."
