"""Families of periodic orbits: their members, their special points, and why they end."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.closed_orbit import Stability
from engine.foundations.arrays import read_only
from engine.foundations.validation import checked_count, checked_number
from engine.foundations.wording import format_count, format_number
from engine.periodic.families.special_points import SpecialKind
from engine.periodic.families.switching import first_orbits_of_branches
from engine.periodic.family_parameter import ENERGY, FamilyParameter, parameter_of_family
from engine.periodic.periodic_orbit import DIGITS, STATE_COLUMNS, PeriodicOrbit, ResultOnSection
from engine.periodic.shooting import Trial, close_orbit, with_parts
from engine.slices.sections.section_text import section_of_file
from engine.systems.formulas.formula_parser import read_potential
from engine.systems.parameters import symbol_of
from engine.systems.potential import Potential
from engine.systems.related_wells import with_well_of
from engine.systems.system import System

if TYPE_CHECKING:
    import xarray as xr

NUMBERS = ("energy", "period", "stability_index", "action")
"""Attributes that are numbers of each member."""

COLUMNS = (*NUMBERS, "states", "time")
"""Attributes that have the values of an attribute of each member."""

# Periods of the family after which the orbits of a branch close; a resonance m : n has its own number n.
_PERIODS_OF_BRANCHES = {SpecialKind.BRANCHING: 1, SpecialKind.DOUBLING: 2, SpecialKind.TOUCHING: 2}
# Kinds of points at which all orbits near the orbit close, to first order in their distance.
_ALL_CLOSE = SpecialKind.TOUCHING, SpecialKind.RESONANCE
# Smallest and largest distance of the first orbits of branches from the special point, and those tried, in units of the well.
_STEPS, _DEFAULT_STEPS = (1e-6, 0.5), (0.01, 0.02, 0.04, 0.08, 0.16, 0.32)


@dataclass(frozen=True)
class SpecialPoint:
    """A special point of a family of periodic orbits.

    Attributes
    ----------
    kind
        What happens there.
    member
        Number of its member in the family, from 0.
    value
        What changes along the family, at the member, dimensionless: h, or the parameter of the system.
    energy, period
        h and T of the member, dimensionless.
    turns, periods
        m and n of a resonance m : n; 0 for another kind.
    converged
        Whether the point was located, to about 1e-12; otherwise it lies between this member and a neighbour.
    """

    kind: SpecialKind
    member: int
    value: float
    energy: float
    period: float
    turns: int = 0
    periods: int = 0
    converged: bool = True

    @property
    def name(self) -> str:
        """The kind in words: "resonance 1:3"."""
        return f"{self.kind.value} {self.turns}:{self.periods}" if self.periods else self.kind.value


@dataclass(frozen=True, eq=False, repr=False)
class OrbitFamily(ResultOnSection):
    """A family of periodic orbits with n returns, along which the energy or a parameter changes, see `continue_family`.

    Its columns have a row for each member. Special points are members. All quantities are dimensionless, and arrays are
    read-only. ``len(family)`` is the number of members, and ``family[k]`` a member as a `PeriodicOrbit`.

    Attributes
    ----------
    value
        (members,) what changes along the family: the energy, or the parameter of the system.
    energy, period, stability_index, action
        (members,) numbers of each member, see `PeriodicOrbit`.
    states
        (members, n, 4) x, y, px, py at the returns of each member.
    time
        (members, n) times of the returns, from 0.
    special
        The special points, in the order of the members.
    ends
        Why the family ends at its first member, and why at its last one.
    complete
        Whether the search has ended, and was not cancelled.
    along
        Name of what changes along the family: "h", or the parameter of the system.
    section
        The surface of section.
    potential
        The potential of the orbit from which the family was continued. Along a parameter, each member has its own.
    """

    value: np.ndarray
    energy: np.ndarray
    period: np.ndarray
    stability_index: np.ndarray
    action: np.ndarray
    states: np.ndarray
    time: np.ndarray
    special: tuple[SpecialPoint, ...] = ()
    ends: tuple[str, ...] = ("", "")
    complete: bool = True
    along: str = ENERGY
    row_dimension: ClassVar = "member"
    held_as: ClassVar = ResultOnSection.held_as | {"states": "x", "time": "time"}
    inner_names: ClassVar = ResultOnSection.inner_names | {"trial"}

    def __len__(self) -> int:
        return len(self.energy)

    def __iter__(self) -> Iterator[PeriodicOrbit]:
        return (self[k] for k in range(len(self)))

    def __getitem__(self, member: int) -> PeriodicOrbit:
        numbers = (float(getattr(self, name)[member]) for name in NUMBERS)
        energy, period, stability_index, action = numbers
        x, y, px, py = (read_only(column) for column in self.states[member].T.copy())
        return PeriodicOrbit(
            energy, period, stability_index, action, self.time[member], x, y, px, py,
            section=self.section, potential=self._potential_at(float(self.value[member])),
        )  # fmt: skip

    def _potential_at(self, value: float) -> Potential:
        """Return the potential in which the orbits of a value move."""
        system = self.potential.system
        if self.along == ENERGY or system is None:
            return self.potential
        return system.with_parameter(self.along, value).potential

    @property
    def symbol(self) -> str:
        """Symbol of what changes along the family: "h" or "ε"."""
        return symbol_of(self.along)

    @property
    def returns(self) -> int:
        """Number of returns in a period."""
        return self.time.shape[1]

    @property
    def stability(self) -> np.ndarray:
        """(members,) the `Stability` of each member."""
        return np.array([Stability.of(index) for index in self.stability_index], object)

    @property
    def points(self) -> np.ndarray:
        """(members, n, 2) returns in the coordinates in which the section is drawn."""
        return self.section.axes.points(self.states)

    def at(self, value: float) -> tuple[PeriodicOrbit, ...]:
        """Return the orbits of the family at an energy, or at a value of its parameter: none beyond its ends, several with folds.

        Raises
        ------
        ValueError
            If `value` is not finite.
        """
        value = checked_number("value", value)
        low, high = self.value[:-1], self.value[1:]
        # A member at this value belongs to one segment only.
        segments = np.flatnonzero(((low <= value) & (value < high)) | ((high < value) & (value <= low)))
        found = [self._between(int(k), value) for k in segments]
        if self.value[-1] == value:
            found.append(self[len(self) - 1])
        return tuple(orbit for orbit in found if orbit is not None)

    def _between(self, member: int, value: float) -> PeriodicOrbit | None:
        """Return the orbit at a value between a member and the next one; None if it is not found."""
        parameter, first, last = self._parameter, self._trial(member), self._trial(member + 1)
        share = (value - self.value[member]) / (self.value[member + 1] - self.value[member])
        returns = last._replace(states=last.states[last.returns], parts=(1,) * self.returns)
        end = with_parts(parameter.at(last.value).potential, returns, first.parts)
        if end is None:
            return None
        guess = first.moved(first.vector + share * (end.vector - first.vector))._replace(value=value / parameter.unit)
        closed = close_orbit(parameter, guess)
        return None if closed is None else self._restored(closed[0])

    def switch(self, number: int, step: float | None = None) -> tuple[PeriodicOrbit, ...]:
        """Return orbits of the other families that meet this one at a special point, one for each branch found, to be continued.

        Where the family branches, there is one on each side; at a period doubling there is one. At a resonance and at a touching
        point there are usually two: those of a chain of islands and of the unstable orbits between them, or one below and one
        above the energy of the point.

        Parameters
        ----------
        number
            Number of the special point in `special`, from 0. Its kind must not be fold, because no other family meets there.
        step
            Distance of the orbits from the special point, 1e-6 to 0.5, in units of the well; None for the smallest of 0.01, 0.02,
            0.04 to 0.32 at which orbits are found. Nearer to a resonance m : n with a large n, all orbits close within rounding
            errors.

        Raises
        ------
        ValueError
            If a parameter is out of range, or no orbit of a branch is found.
        """
        if not self.special:
            raise ValueError(f"number={number}: the family has no special points")
        point = self.special[checked_count("number", number, 0, len(self.special) - 1)]
        legal = [k for k, each in enumerate(self.special) if each.kind is not SpecialKind.FOLD and each.converged]
        if number not in legal:
            raise ValueError(f"number={number}: no other family is followed from this {point.name}; must be one of {legal}")
        if step is not None and not _STEPS[0] <= (step := checked_number("step", step)) <= _STEPS[1]:
            raise ValueError(f"step={step:g}: must be from {_STEPS[0]:g} to {_STEPS[1]:g}")
        member, before, after = map(self._trial, (point.member, max(point.member - 1, 0), min(point.member + 1, len(self) - 1)))
        periods = point.periods or _PERIODS_OF_BRANCHES[point.kind]
        dimensions = 2 if point.kind in _ALL_CLOSE else 1
        for distance in _DEFAULT_STEPS if step is None else (step,):
            orbits = first_orbits_of_branches(self._parameter, member, (before, after), periods, dimensions, distance)
            if orbits:
                return tuple(map(self._restored, orbits))
        raise ValueError(f"step={step}: no orbit of a branch was found at this distance; choose another one")

    @property
    def _parameter(self) -> FamilyParameter:
        bounds = float(self.value.min()), float(self.value.max())
        return parameter_of_family(self.potential, self.section, self.along, bounds, float(self.energy[0]))

    def trial(self, member: int, parameter: FamilyParameter) -> Trial:
        """Return a member in the units of the well of the family and of a parameter."""
        orbit = self[member]
        if orbit.potential is not self.potential:
            orbit = replace(orbit, potential=with_well_of(orbit.potential, self.potential))
        return orbit.trial._replace(value=float(self.value[member]) / parameter.unit)

    def _trial(self, member: int) -> Trial:
        return self.trial(member, self._parameter)

    def _restored(self, orbit: Trial) -> PeriodicOrbit:
        """Return an orbit in the units of the well of the family and of its parameter as one of its own potential."""
        parameter, value = self._parameter, orbit.value
        restored = PeriodicOrbit.from_trial(
            parameter.potential_at(value), self.section, orbit._replace(value=parameter.energy_at(value))
        )
        return replace(restored, potential=self._potential_at(value * parameter.unit))

    def describe(self) -> str:
        """Describe the family in a sentence."""
        low, high = (format_number(bound, DIGITS) for bound in (self.value.min(), self.value.max()))
        folds = format_count(sum(point.kind is SpecialKind.FOLD for point in self.special), "fold")
        others = format_count(sum(point.kind is not SpecialKind.FOLD for point in self.special), "other special point")
        members = format_count(len(self), "member")
        return f"Family of periodic orbits with {members} from {self.symbol} = {low} to {high}, {folds}, {others}."

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return a table with a row for each member: its numbers and its first return."""
        numbers = {name: getattr(self, name) for name in ("value", *NUMBERS)}
        return numbers | {name: self.states[:, 0, k] for k, name in enumerate(STATE_COLUMNS)}

    def to_xarray(self) -> xr.Dataset:
        """Return the dataset with the dimensions "member" and "return"."""
        dataset = super().to_xarray()
        states = {name: (("member", "return"), self.states[..., k], {"units": "1"}) for k, name in enumerate(STATE_COLUMNS)}
        return dataset.assign(states | {"time": (("member", "return"), self.time, {"units": "1"})})

    def provenance(self) -> dict[str, Any]:
        """Return the potential, its system, the section, the integrator and the version."""
        system = self.potential.system
        return super().provenance() | ({} if system is None else {"system": json.dumps(asdict(system))})

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the section, the states and the times, which files store in other forms."""
        states = np.stack([dataset[name].transpose("member", "return").values for name in STATE_COLUMNS], axis=-1)
        time = dataset["time"].transpose("member", "return").values
        parts = {"section": section_of_file(dataset.attrs), "states": read_only(states), "time": read_only(time)}
        if "system" not in dataset.attrs:
            return parts
        # The potentials of members are those of the system.
        system = System(**json.loads(dataset.attrs["system"]))
        return parts | {"potential": replace(read_potential(dataset.attrs), system=system)}
