"""The picture of a link: what other programs show of a view beside its address."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.state.permalink import fit_to_system, linked_system, refused_link
from app.state.system_review import map_energy
from app.state.view_state import ViewState
from engine import MapSpec, Slice, System, Window
from engine.potentials.formulas.formula_parser import formula_letters
from engine.potentials.review.potential_review import SystemReview
from engine.potentials.system import TYPED
from engine.results.wording import format_number
from plots.accepted_potentials import refusal

LONGEST_FORMULA = 80
"""Largest number of characters of a formula in a title."""

SIDE = 210
"""Columns and rows of the map in a picture."""

LONGEST_TIME = 1000.0
"""Largest t_max of a picture, in units of the well."""


@dataclass(frozen=True)
class LinkPicture:
    """The part of a link that its picture shows; links that differ in nothing else have the same picture.

    Attributes
    ----------
    system
        The system, not reviewed yet.
    plane
        The slice of starts.
    energy
        h, dimensionless; None for the first energy of the system.
    window
        Part of the plane; None for the whole interior.
    t_max
        Time horizon of the view, dimensionless, above 0.
    palette
        A key of `plots.palette.PALETTES`.
    """

    system: System
    plane: Slice
    energy: float | None
    window: Window | None
    t_max: float
    palette: str

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

    def map_spec(self, reviewed: SystemReview) -> MapSpec:
        """Specification of the map; ValueError if the system is refused or the energy or the window is invalid.

        Parameters
        ----------
        reviewed
            The review of the system.
        """
        problem = refusal(reviewed)
        if problem is not None:
            raise ValueError(refused_link(problem))
        shown, problems = fit_to_system({} if self.energy is None else {"energy": self.energy}, reviewed)
        if problems:
            raise ValueError(" ".join(problems))
        potential = reviewed.potential
        t_max = min(self.t_max, LONGEST_TIME * potential.units.time)
        return MapSpec(potential, self.plane, map_energy(reviewed, self.plane, shown["energy"]), (SIDE, SIDE), self.window, t_max)


def picture_of(values: Mapping[str, Any]) -> LinkPicture:
    """The picture of a link, from the values of `app.state.permalink.read_link`."""
    chosen = {name: values.get(name, ViewState.param[name].default) for name in ("plane", "window", "t_max", "palette")}
    return LinkPicture(system=linked_system(values), energy=values.get("energy"), **chosen)


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
