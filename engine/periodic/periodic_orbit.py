"""A periodic orbit: its returns to a surface of section, its period and its stability."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.result import Result
from engine.foundations.validation import checked_count
from engine.foundations.wording import format_count, format_number
from engine.periodic.closed_orbits import action, sampled_path, stability_index
from engine.periodic.shooting import Trial, divided
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import section_of_file
from engine.systems.potential import Potential

if TYPE_CHECKING:
    import xarray as xr

DIGITS = 6
"""Digits of the period and of the stability index in sentences."""

STATE_COLUMNS = ("x", "y", "px", "py")
"""Names of the columns of states."""


class Stability(StrEnum):
    """The motion near a periodic orbit, from its stability index a = ½ (tr M − 2) with the monodromy matrix M.

    Nearby orbits stay near a stable orbit, abs(a) ≤ 1. They leave an unstable orbit along two curves: on the same side, a > 1, or
    on alternating sides (with reflection), a < −1.
    """

    STABLE = "stable"
    UNSTABLE = "unstable"
    REFLECTING = "unstable with reflection"

    @classmethod
    def of(cls, index: float) -> Stability:
        """Return the stability that belongs to a stability index, a finite number."""
        return cls.STABLE if abs(index) <= 1.0 else cls.UNSTABLE if index > 1.0 else cls.REFLECTING


@dataclass(frozen=True, eq=False, repr=False)
class ResultOnSection(Result):
    """Base of results on periodic orbits.

    Attributes
    ----------
    section
        The surface of section to which the orbits return.
    potential
        The potential in which they move.
    """

    section: Section = field(kw_only=True)
    potential: Potential = field(kw_only=True, repr=False)
    held_as: ClassVar[dict[str, str]] = {"section": "section"}

    def provenance(self) -> dict[str, Any]:
        """Return the potential, the section, the integrator and the version."""
        return self.potential.describe_run(section=self.section.text)

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the section, which files hold as text."""
        return {"section": section_of_file(dataset.attrs)}


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit(ResultOnSection):
    """A periodic orbit with its n returns to a section in a period; all quantities are dimensionless, and arrays are read-only.

    Attributes
    ----------
    energy
        Energy h of the orbit.
    period
        Its period T.
    stability_index
        a = ½ (tr M − 2), with the monodromy matrix M of one period.
    action
        J = ∮ p dq over one period, with the canonical momenta; dJ/dh = T along a family.
    time
        (n,) times of the returns, from 0.
    x, y, px, py
        (n,) states at the returns, in the order of time.
    section
        The surface of section.
    potential
        The potential in which the orbit moves.
    """

    energy: float
    period: float
    stability_index: float
    action: float
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    px: np.ndarray
    py: np.ndarray
    row_dimension: ClassVar = "return"
    inner_names: ClassVar = Result.inner_names | {"from_trial", "trial"}

    @classmethod
    def from_trial(
        cls,
        potential: Potential,
        section: Section,
        orbit: Trial,
        known_index: float | None = None,
        known_action: float | None = None,
    ) -> PeriodicOrbit:
        """Return a closed orbit in units of the well as an orbit of a potential, with a section in the units of the potential.

        The value of the orbit is its energy.

        The stability index and the action, in the units of the potential, are computed unless they are known.
        """
        units, well = potential.units, potential.in_well_units
        times = np.concatenate([[0.0], np.cumsum(orbit.durations)]) * units.time
        states = section.settle(orbit.states[orbit.returns] * units.state)
        return cls(
            orbit.value * units.energy, float(times[-1]), stability_index(well, orbit) if known_index is None else known_index,
            action(well, orbit) * units.length * units.momentum if known_action is None else known_action,
            read_only(times[:-1]), *map(read_only, states.T.copy()), section=section, potential=potential,
        )  # fmt: skip

    @property
    def trial(self) -> Trial:
        """The orbit in units of the well, with as many nodes as its instability needs."""
        units = self.potential.units
        durations = np.diff(self.time, append=self.period) / units.time
        orbit = Trial(self.states / units.state, durations, self.energy / units.energy, (1,) * len(durations))
        return divided(self.potential.in_well_units, orbit)

    @property
    def states(self) -> np.ndarray:
        """(n, 4) x, y, px, py at the returns."""
        return np.column_stack([self.x, self.y, self.px, self.py])

    @property
    def state(self) -> np.ndarray:
        """(4,) x, y, px, py at the first return, from which the orbit starts."""
        return self.states[0]

    @property
    def returns(self) -> int:
        """Number of returns in a period."""
        return len(self.time)

    @property
    def points(self) -> np.ndarray:
        """(n, 2) returns in the coordinates in which the section is drawn."""
        return self.section.axes.points(self.states)

    @property
    def stability(self) -> Stability:
        """The motion near the orbit."""
        return Stability.of(self.stability_index)

    @property
    def residue(self) -> float:
        """Greene's residue R = ½ (1 − a): stable from 0 to 1, unstable below 0, unstable with reflection above 1."""
        return 0.5 * (1.0 - self.stability_index)

    @property
    def rotation_number(self) -> float:
        """Turns of a nearby orbit around a stable orbit in a period, arccos(a)/2π, 0 to ½; NaN for an unstable orbit."""
        return float(np.arccos(self.stability_index) / (2.0 * np.pi)) if abs(self.stability_index) <= 1.0 else np.nan

    @property
    def multipliers(self) -> np.ndarray:
        """(2,) complex eigenvalues λ and 1/λ of the return map at a return, abs(λ) ≥ 1; the other two multipliers are 1."""
        index = complex(self.stability_index)
        root = np.sqrt(index * index - 1.0)
        larger = index + root if self.stability_index >= 0.0 else index - root
        return read_only(np.array([larger, 1.0 / larger]))

    def find_path(self, points: int = 400) -> np.ndarray:
        """Return the path of one period, of shape (5, m): t, x, y, px and py at about this number of times, 2 to 1e6.

        The last point is the first one. Integration over several periods would leave an unstable orbit.
        """
        path = sampled_path(self.potential.in_well_units, self.trial, checked_count("points", points, 2, 10**6))
        units = self.potential.units
        return path * np.array([units.time, *units.state])[:, None]

    def describe(self) -> str:
        """Describe the orbit in a sentence."""
        period, index = (format_number(each, DIGITS) for each in (self.period, self.stability_index))
        returns = format_count(self.returns, "return")
        return f"Periodic orbit, {self.stability}, T = {period}, a = {index}, {returns} to {self.section.place}."

    def provenance(self) -> dict[str, Any]:
        """Return the potential, the energy, the section, the integrator and the version."""
        return self.potential.describe_run(energy=self.energy, section=self.section.text)

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return a table with a row for each return."""
        return {"time": self.time, **{name: getattr(self, name) for name in STATE_COLUMNS}}
