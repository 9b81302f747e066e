"""Error messages for the page; details go to the log."""

from __future__ import annotations

import logging
import re

log = logging.getLogger(__name__)

# The page calls the parameter `energy` of the library h.
_ENERGY = re.compile(r"\benergy=(-?[\d.]+(?:e[+-]?\d+)?): ")

ZOOM_ENDS = "Double precision ends here: pixels cannot be closer together."


def sentence(error: Exception) -> str:
    """Message of a ValueError, which is written for users; for other errors a reference to the log, where they are logged."""
    if isinstance(error, ValueError):
        return _ENERGY.sub(lambda named: f"h = {float(named[1]):.6g}: ", str(error))
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."
