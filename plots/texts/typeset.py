"""The notation of symbols, numbers and powers in HTML."""

from __future__ import annotations

import re

# Spaces beside a sign such as = or ×, where a line must not break.
_AROUND_SIGN = re.compile(r"(?<=\w) (?=(?:=|≈) [−-]?\d)|(?<=[=≤×]) (?=[−-]?\d)|(?<=\d) (?=×)")
# Letters with a subscript, such as S_b, px and ω1.
_SUBSCRIPT = re.compile(r"\b(?:([A-Za-z])_|(p)(?=[xy]\b)|(ω)(?=[12]\b))([a-z]{1,3}|\d)\b")
# Powers of e and of t.
_POWER = re.compile(r"\b([et])\^(\d+(?:\.\d+)?)")
# Spaces before a per cent sign and between groups of digits, which become narrow.
_IN_NUMBER = re.compile(r"(?<=\d) (?=%|\d{3}\b)")


def typeset(html: str) -> str:
    """Return HTML whose lines do not break inside a number, with subscripts and powers, such as px, ω1, S_b and e^6.5."""
    # Text and tags alternate: every second part is text.
    parts = re.split(r"(<[^>]*>)", html)
    for space, pattern in (("\N{NO-BREAK SPACE}", _AROUND_SIGN), ("\N{NARROW NO-BREAK SPACE}", _IN_NUMBER)):
        parts[::2] = [pattern.sub(space, part) for part in parts[::2]]
    for replacement, pattern in ((r"\1\2\3<sub>\4</sub>", _SUBSCRIPT), (r"\1<sup>\2</sup>", _POWER)):
        parts[::2] = [pattern.sub(replacement, part) for part in parts[::2]]
    return "".join(parts)
