"""Error messages for the page. The log gets the details."""

from __future__ import annotations

import logging
import re

from engine import NoPeriodicOrbitError
from engine.foundations.wording import format_number

log = logging.getLogger(__name__)

# Texts for visitors, by the beginnings of the messages of `engine` about an energy. "" begins any message.
_ENERGY_PROBLEMS = {
    "the interior is empty on": "no orbit of this energy starts on this slice, as the well lies higher.",
    "no Lyapunov orbit was found": "there is no neck to leave through; choose another energy.",
    "": r"\g<rest>",
}
_ENERGY = re.compile(r"\benergy=(?P<energy>-?[\d.]+(?:e[+-]?\d+)?): (?P<rest>.*)", re.DOTALL)

ZOOM_ENDS = "Double precision ends here: pixels cannot be closer together."
"""Message for a zoom beyond the smallest window."""


def error_sentence(error: Exception) -> str:
    """Return the message of an error that is meant for users. Log any other error, and return a reference to the log."""
    if isinstance(error, ValueError | NoPeriodicOrbitError):
        return _ENERGY.sub(_explain, str(error))
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."


def _explain(match: re.Match[str]) -> str:
    """Return the text for a message about an energy, which the page calls h."""
    template = next(text for beginning, text in _ENERGY_PROBLEMS.items() if match["rest"].startswith(beginning))
    return f"h = {format_number(float(match['energy']), 6)}: {match.expand(template)}"
