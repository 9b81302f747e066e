"""Panes of text, and the notation of symbols and percentages on the page."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import panel as pn
from bokeh.document import Document

from engine import Potential
from engine.foundations.wording import format_number, format_share, format_whole
from engine.results import EscapeStatistics, PotentialReview
from plots.texts.typeset import typeset

# Spaces at an equals sign, after an operator and inside brackets, where lines of a formula must not break.
_IN_TERM = re.compile(r"(?<=[=+−]) | (?==)| (?=[^()]*\))")
# The digit of a symbol such as ω1.
_INDEX = re.compile(r"(?<=\b[^\W\d_])\d\b")
_SUBSCRIPT_DIGITS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def breakable(formula: str) -> str:
    """Return a formula whose lines break only before the operators outside brackets."""
    return _IN_TERM.sub("\N{NO-BREAK SPACE}", formula)


def plain_symbol(text: str) -> str:
    """Return a label that is not HTML, such as the symbol of a parameter, with the digits of its symbols as subscripts."""
    return _INDEX.sub(lambda match: match[0].translate(_SUBSCRIPT_DIGITS), text)


def describe_outcomes(review: PotentialReview) -> str:
    """Describe the ends of orbits, and the energies above which exits are open, or up to which a well without exits is closed."""
    potential = review.potential
    if not potential.ends:
        return _describe_openings(potential) or f"no exits, closed at least up to h = {format_number(review.closed_energy)}"
    labels = ", ".join(outcome.label for outcome in potential.outcomes)
    openings = f"exits open above h = {format_number(potential.escape_energy)}" if potential.channels else ""
    return "; ".join(part for part in (labels, openings) if part)


def _describe_openings(potential: Potential) -> str:
    """Return how many exits are open above which energies: "2 exits above h = 0.1109, 3 above 0.1667"; empty without exits."""
    energies = [format_number(energy) for energy in np.sort(potential.well.saddle_energies)]
    counts = {energy: count for count, energy in enumerate(energies, 1)}
    if not counts:
        return ""
    (lowest, first_count), *others = counts.items()
    exits = "exit" if first_count == 1 else "exits"
    return ", ".join([f"{first_count} {exits} above h = {lowest}", *(f"{count} above {energy}" for energy, count in others)])


def escape_facts(statistics: EscapeStatistics) -> dict[str, str]:
    """Return the numbers that describe the escapes of all starts, by name."""
    mean, median = statistics.mean_escape_time, statistics.median_escape_time
    times = (format_number(time) if math.isfinite(time) else "nothing escaped" for time in (mean, median))
    return {
        "interior starts": format_whole(statistics.starts),
        "direct escapes": format_share(statistics.direct_share, 2),
        **dict(zip(("mean escape time", "median escape time"), times, strict=True)),
    }


class TextPane(pn.pane.HTML):
    """A pane of HTML with typographic spaces. Its text may change while the pane is not on the page.

    With each text, Panel also sets the stylesheets, which depend on the model's document. A model that is not on the page has
    no document, and would load a stylesheet from Panel's content delivery network, which the page must not do.
    """

    def _transform_object(self, obj: Any) -> dict[str, Any]:
        return dict(super()._transform_object(typeset(obj or "")))

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        properties: dict[str, Any] = super()._get_properties(doc)
        if doc is None:
            # Without this entry, the model keeps its stylesheets.
            properties.pop("stylesheets", None)
        return properties


class StatusPane(TextPane):
    """A pane whose new text screen readers announce once they have finished the present text."""

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        return {**super()._get_properties(doc), "html_attributes": {"role": "status"}}
