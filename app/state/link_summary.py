"""What other programs show of a link beside its address."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.state.permalink import linked_system
from app.state.view_state import ViewState
from engine import Slice, System
from engine.foundations.wording import format_number
from engine.systems.formulas.formula_parser import formula_letters
from engine.systems.system import TYPED

LONGEST_FORMULA = 80
"""Largest number of characters of a formula in a title."""


@dataclass(frozen=True)
class LinkSummary:
    """The part of a link that its title and its sentence name.

    Attributes
    ----------
    system
        The system, not reviewed yet.
    plane
        The slice of starts.
    energy
        h, dimensionless; None for the first energy of the system.
    """

    system: System
    plane: Slice
    energy: float | None

    @property
    def title(self) -> str:
        """Name of the system, with the formula of a typed one."""
        formula = _shown_formula(self.system)
        return f"{self.system.title}, V = {formula}" if formula else self.system.title

    def describe(self) -> str:
        """What the view shows, in one sentence."""
        has_energy = self.energy is not None and self.plane.energy_axis is None
        energy = f" at h = {format_number(self.energy or 0.0, 6)}" if has_energy else ""
        return (
            f"{self.title} on the plane {self.plane.title}{energy}: "
            "each start of an orbit has the colour of the exit through which the orbit leaves the well."
        )


def summary_of(values: Mapping[str, Any]) -> LinkSummary:
    """The summary of a link, from the values of `app.state.permalink.read_link`."""
    return LinkSummary(linked_system(values), values.get("plane", ViewState.param["plane"].default), values.get("energy"))


def _shown_formula(system: System) -> str:
    """A typed formula without its clauses, which contain names; empty if it is long or has words that no formula has.

    Other programs show it as a text of this server, whoever wrote the link.
    """
    formula = system.formula.partition(";")[0].strip() if system.case == TYPED else ""
    try:
        formula_letters(formula)
    except ValueError:
        return ""
    return formula if len(formula) <= LONGEST_FORMULA else ""
