"""What other programs show of a link beside its address."""

from __future__ import annotations

from app.state.view import View
from engine import System
from engine.foundations.wording import format_number
from engine.systems.formulas.formula_parser import formula_letters
from engine.systems.system import TYPED

LONGEST_FORMULA = 80
"""Largest number of characters of a formula in a title."""


def link_title(view: View) -> str:
    """Name of the system, with the formula of a typed one."""
    formula = _shown_formula(view.system)
    return f"{view.system.title}, V = {formula}" if formula else view.system.title


def link_sentence(view: View) -> str:
    """What the view shows, in one sentence."""
    energy = "" if view.known_energy is None else f" at h = {format_number(view.known_energy, 6)}"
    return (
        f"{link_title(view)} on the plane {view.plane.title}{energy}: "
        "each start of an orbit has the colour of the exit through which the orbit leaves the well."
    )


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
