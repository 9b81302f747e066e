"""What a person may read of an error; the rest goes to the log."""

from __future__ import annotations

import logging

log = logging.getLogger(__name__)


def sentence(error: Exception) -> str:
    """The error's own words where it was written for people, else a word that the log knows more."""
    if isinstance(error, ValueError):
        return str(error)
    log.error("a job failed", exc_info=error)
    return "This could not be computed; the server's log says why."


def as_markdown(text: str) -> str:
    """A text as Markdown that shows it as it is: whatever might be markup, of Markdown or of HTML, is written as a number."""
    return "".join(one if one.isalnum() or one in " .,:;=…" else f"&#{ord(one)};" for one in text)
