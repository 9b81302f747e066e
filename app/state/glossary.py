"""The glossary of the page, and texts whose terms open their explanations."""

from __future__ import annotations

import re
from collections.abc import Mapping
from html import escape
from types import MappingProxyType

from engine import MEASURES

GLOSSARY: Mapping[str, str] = MappingProxyType(
    {
        "interior starts": (
            "Starts that are allowed at this energy and lie inside all Lyapunov orbits. All shares refer to them, "
            "so that they do not depend on how much of the plane is shown."
        ),
        "on evidence": (
            "Called bounded before t_max: the energy is below all saddles, which is exact, or averages along the "
            "orbit, or along orbits around it, converge as on an invariant torus, which is numerical evidence."
        ),
        "doubtful": (
            "Pixels whose fate, crossings or escape time change when the start is shifted by 10⁻¹¹: they depend "
            "on rounding errors."
        ),
        "SALI": (
            "Smaller alignment index: how far two small deviations of an orbit are from being parallel. It falls "
            "exponentially to zero if the orbit is chaotic, and slowly or not at all if it is regular."
        ),
        "Lyapunov exponent": (
            "The mean exponential growth rate of small deviations: positive for chaotic orbits, zero for regular ones."
        ),
        "Birkhoff digits": (
            "The number of digits to which weighted averages of x² and y² over two intervals of time agree. It "
            "grows with the intervals for regular orbits, and stays small for chaotic ones."
        ),
        "limiting curve": "The edge of the allowed starts of a plane: there the momentum that the energy decides is zero.",
        "Lyapunov orbit": (
            "The unstable periodic orbit over a saddle of the potential, which marks the exit. In the cases of the paper, an "
            "orbit that crosses it outward never returns. Elsewhere some orbits may; the flux says how many."
        ),
        "Jacobi integral": (
            "The energy in a frame that rotates: half the square of the velocity, plus the effective potential Φ, which contains "
            "the centrifugal force."
        ),
        "centre": "A body: an orbit that enters the disc around it has collided with it.",
        "escape radius": "A distance from the origin beyond which orbits have escaped, in place of exits over saddles.",
        "shares on a slider": (
            "The picture on the slider of the energy, or of the parameter moved last, shows how the starts in view divide among "
            "the exits at each value. It counts the pixels of coarse maps, for a shorter time: grey is still inside."
        ),
        "direct escapes": "Orbits that escape without a crossing of the section, of y = 0 upward by default.",
        **{term: meaning for measure in MEASURES.values() for term, meaning in measure.terms.items()},
    }
)
"""Meaning of each term, in one or two sentences."""

_TERM = re.compile(rf"(?<!\w)({'|'.join(sorted(map(re.escape, GLOSSARY), key=len, reverse=True))})(?!\w)", re.IGNORECASE)
_TERMS_BY_LOWER_CASE = {term.lower(): term for term in GLOSSARY}


def with_terms(html: str) -> str:
    """Return HTML in which the first occurrence of each term is a button that opens its explanation.

    Two such texts of one shadow root must not have a common term, because identifiers must be unique.
    """
    explained_terms: dict[str, None] = {}

    def explain(match: re.Match[str]) -> str:
        term = _TERMS_BY_LOWER_CASE[match[0].lower()]
        if term in explained_terms:
            return match[0]
        explained_terms[term] = None
        return f"<button type='button' class='term' popovertarget='{_identifier(term)}'>{match[0]}</button>"

    # Texts and tags alternate, and only texts contain terms.
    parts = re.split(r"(<[^>]*>)", html)
    parts[::2] = [_TERM.sub(explain, part) for part in parts[::2]]
    meanings = (
        f"<span id='{_identifier(term)}' class='help-text' popover>{escape(GLOSSARY[term])}</span>" for term in explained_terms
    )
    return "".join([*parts, *meanings])


def glossary_list() -> str:
    """Return an HTML list of all terms."""
    return "".join(
        ["<dl class='terms'>", *(f"<dt>{term}</dt><dd>{escape(text)}</dd>" for term, text in GLOSSARY.items()), "</dl>"]
    )


def _identifier(term: str) -> str:
    return f"term-{term.lower().replace(' ', '-')}"
