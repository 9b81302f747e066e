"""Error messages for the page; details go to the log."""

from __future__ import annotations

import logging
import re

log = logging.getLogger(__name__)

# The page says h for the parameter `energy` of the library.
_ENERGY = re.compile(r"\benergy=(-?[\d.]+(?:e[+-]?\d+)?): ")

ZOOM_ENDS = "Double precision ends here: pixels cannot be closer together."


def sentence(error: Exception) -> str:
    """Return the message of a ValueError, which is meant for users; other errors are logged, and the message names the log."""
    if isinstance(error, ValueError):
        return _ENERGY.sub(lambda named: f"h = {float(named[1]):.6g}: ", str(error))
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."
