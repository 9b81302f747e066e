"""A periodic orbit: its returns to a surface of section, its period and its stability."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.closed_orbit import ClosedOrbit, Nodes
from engine.foundations.arrays import read_only
from engine.foundations.result import Result
from engine.foundations.wording import format_count, format_number
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
class PeriodicOrbit(ResultOnSection, ClosedOrbit):
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
    inner_names: ClassVar = ClosedOrbit.inner_names | {"from_trial", "trial"}

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
        index = orbit.nodes.stability_index(well) if known_index is None else known_index
        action = orbit.nodes.action(well) * units.length * units.momentum if known_action is None else known_action
        return cls(
            orbit.value * units.energy, float(times[-1]), index, action,
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
    def start(self) -> np.ndarray:
        """(4,) x, y, px, py at the first return, from which the orbit starts."""
        return self.states[0]

    @property
    def nodes(self) -> Nodes:
        """See `ClosedOrbit.nodes`."""
        return self.trial.nodes

    @property
    def returns(self) -> int:
        """Number of returns in a period."""
        return len(self.time)

    @property
    def points(self) -> np.ndarray:
        """(n, 2) returns in the coordinates in which the section is drawn."""
        return self.section.axes.points(self.states)

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
