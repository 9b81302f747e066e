"""Wells whose exits follow from another potential without a search, and potentials in units of their wells."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.validation import replace_unchecked
from engine.systems.landscape.exit_saddles import find_exit_lines, in_channel_order
from engine.systems.merged_channels import ChannelMerger
from engine.systems.well import Well
from engine.systems.well_units import WellUnits

if TYPE_CHECKING:
    from engine.systems.potential import Potential


@dataclass(frozen=True, eq=False)
class ScaledWell(Well):
    """The well of a potential that has been converted to units of this well.

    Attributes
    ----------
    stated
        The same well in the units of the original potential. Lengths and energies are converted exactly, by powers of 2.
    """

    stated: Well

    @cached_property
    def units(self) -> WellUnits:
        """Units of 1, because the potential is already in units of its well."""
        return WellUnits()

    @property
    def stated_units(self) -> WellUnits:
        """The units of the original potential."""
        return self.stated.units

    @cached_property
    def saddles(self) -> np.ndarray:
        """See `Well.saddles`."""
        return read_only(self.stated.saddles / self.stated_units.length)

    @cached_property
    def outward_directions(self) -> np.ndarray:
        """See `Well.outward_directions`."""
        return self.stated.outward_directions

    @cached_property
    def exits_unknown(self) -> str:
        """See `Well.exits_unknown`."""
        return self.stated.exits_unknown

    @cached_property
    def closed_energy(self) -> float:
        """See `Well.closed_energy`."""
        return self.stated.closed_energy / self.stated_units.energy

    @cached_property
    def exit_lines(self) -> tuple[np.ndarray, ...]:
        """See `Well.exit_lines`."""
        return tuple(line / self.stated_units.length for line in self.stated.exit_lines)

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """See `Well.channel_mergers`."""
        units = self.stated_units
        return tuple(
            ChannelMerger(energy / units.energy, x / units.length, y / units.length, channels)
            for energy, x, y, channels in self.stated.channel_mergers
        )


@dataclass(frozen=True, eq=False)
class ContinuedWell(Well):
    """A well whose exits were continued from the exits of a nearby potential.

    Attributes
    ----------
    exit_saddles
        The saddles of all exits, of shape (n, 2), in any order.
    maxima
        The maxima between exits, of shape (m, 2).
    saddle_indices
        For each maximum, the indices in `exit_saddles` of the exits that it separates.
    """

    exit_saddles: np.ndarray
    maxima: np.ndarray
    saddle_indices: Sequence[Sequence[int]]

    @cached_property
    def exits_unknown(self) -> str:
        """See `Well.exits_unknown`."""
        return ""

    @cached_property
    def saddles(self) -> np.ndarray:
        """See `Well.saddles`."""
        return read_only(in_channel_order(self.exit_saddles, self.mirrors))

    @cached_property
    def exit_lines(self) -> tuple[np.ndarray, ...]:
        """See `Well.exit_lines`. Critical points other than the origin and those of the exits are not known."""
        points = np.concatenate([self.saddles, np.zeros((1, 2)), self.maxima])
        indices = np.where(np.arange(len(points)) < self.channels, -1, 1)
        rows = find_exit_lines(self.form, points, indices)
        return tuple(rows[rows[:, 0] == k, 1:] for k in range(self.channels))

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """See `Well.channel_mergers`."""
        # The channels of `exit_saddles`.
        channels = np.array([1 + np.argmin(np.hypot(*(self.saddles - saddle).T)) for saddle in self.exit_saddles], int)
        return self._mergers_at(self.maxima, [np.sort(channels[list(indices)]) for indices in self.saddle_indices])


@dataclass(frozen=True, eq=False)
class BorrowedWell(Well):
    """A well with the exits and the units of another one, for orbits that are followed beyond all exits.

    Attributes
    ----------
    lender
        The well of another potential.
    """

    lender: Well

    @cached_property
    def units(self) -> WellUnits:
        """The units of length and energy of the other well, and the mass of this one."""
        return replace(self.lender.units, mass=self.mass)

    @cached_property
    def exits_unknown(self) -> str:
        """See `Well.exits_unknown`."""
        return self.lender.exits_unknown

    @cached_property
    def saddles(self) -> np.ndarray:
        """The saddles of the other well."""
        return self.lender.saddles

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """The maxima of the other well."""
        return self.lender.channel_mergers


@dataclass(frozen=True)
class Lineage:
    """The way in which the well of a potential is found.

    Attributes
    ----------
    family
        Name of the family from which the exits were continued (`ParameterFamily`), or of the potential from which they were
        borrowed; otherwise empty. Such exits differ from exits found from the critical points, continued ones perhaps in the
        last bit, so caches keep their results apart.
    make_well
        Function that makes the well from form, rotation, ends and mass. Lineages with the same `family` compare equal.
    """

    family: str = ""
    make_well: Callable[..., Well] = field(default=Well, compare=False)


SEARCHED = Lineage()
"""Lineage of a well whose exits are searched among the critical points."""


def scaled_to_well(potential: Potential) -> Potential:
    """Return a potential in units of its well, see `Potential.in_well_units`."""
    units = potential.units
    # The legal ranges apply only in the original units.
    return replace_unchecked(
        potential,
        form=potential.form.scaled(units.length, units.energy),
        rotation=potential.rotation * units.time,
        ends=tuple(end.scaled(1.0 / units.length) for end in potential.ends),
        lineage=replace(potential.lineage, make_well=partial(ScaledWell, stated=potential.well)),
        system=None,
        mass=1.0,
    )


def with_well_of(potential: Potential, lender: Potential) -> Potential:
    """Return a potential with the exits and the units of length and energy of another one, without a search for its own.

    The number of exits decides on the compiled functions, and periodic orbits depend on the exits in no other way.
    """
    lineage = Lineage(f"exits of {lender.form.text}", partial(BorrowedWell, lender=lender.well))
    return replace(potential, lineage=lineage)
