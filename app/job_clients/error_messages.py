"""Error messages for the page; details go to the log."""

from __future__ import annotations

import logging
import re

from engine.foundations.wording import format_number

log = logging.getLogger(__name__)

# What the library says of an energy, for whose parameter the page says h, and what a visitor needs to know.
_OF_ENERGY = {
    "the interior is empty on": "no orbit of this energy starts on this slice, as the well lies higher.",
    "no Lyapunov orbit was found": "there is no neck to leave through; choose another energy.",
    "": r"\g<rest>",
}
_ENERGY = re.compile(r"\benergy=(?P<energy>-?[\d.]+(?:e[+-]?\d+)?): (?P<rest>.*)", re.DOTALL)

ZOOM_ENDS = "Double precision ends here: pixels cannot be closer together."


def sentence(error: Exception) -> str:
    """Return the message of a ValueError, which is meant for users; other errors are logged, and the message names the log."""
    if isinstance(error, ValueError):
        return _ENERGY.sub(_explain, str(error))
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."


def _explain(found: re.Match[str]) -> str:
    explained = next(words for start, words in _OF_ENERGY.items() if found["rest"].startswith(start))
    return f"h = {format_number(float(found['energy']), 6)}: {found.expand(explained)}"
