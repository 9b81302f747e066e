"""The potentials along two parameters of a system, with exits that keep their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from engine.foundations.arrays import read_only
from engine.slices.axes import ParameterAxis
from engine.slices.parameter_family import Member, parameter_family
from engine.systems.outcomes import Exit, Outcome


class PlateFamily:
    """Finds potentials along a parameter at several values of a second one, and numbers their outcomes.

    Outcomes are followed along the second parameter, at the system's own value of the first, and from there along the first, in
    the family of a `ParameterAxis` at each value of the second. Exits that appear along the first parameter get the next
    numbers, in the order in which they appear there. `plate_family` returns the family of a pair of axes.

    Parameters
    ----------
    first, second
        The parameters, of the same system.
    second_values
        The values of the second parameter.

    Raises
    ------
    ValueError
        If the system has no potential at one of the values, or a `ManyExitsError` if its exits change too often.
    """

    def __init__(self, first: ParameterAxis, second: ParameterAxis, second_values: Sequence[float]) -> None:
        origins = parameter_family(second)
        # For each value of the second parameter, the numbers at the system's own value of the first.
        self._known = {value: origins.member(value).numbers for value in second_values}
        self._known_outcomes = origins.outcomes
        self._families = {value: parameter_family(axis) for value, axis in lines(first, second, second_values).items()}

    def member(self, first_value: float, second_value: float) -> Member:
        """Return the potential at values of the parameters; ValueError as in `ParameterFamily.member`."""
        known, found = self._known[second_value], self._families[second_value].member(first_value)
        appeared = len(self._known_outcomes) + 1 + np.arange(len(self._families[second_value].outcomes) + 1 - known.size)
        return replace(found, numbers=read_only(np.concatenate([known, appeared]).astype(np.int8)[found.numbers]))

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes of all potentials of the family that have been found so far."""
        exit_count = sum(outcome.kind is Exit for outcome in self._known_outcomes)
        most = max(len(family.outcomes) + 1 - self._known[value].size for value, family in self._families.items())
        return self._known_outcomes + tuple(Exit.outcome(exit_count + k) for k in range(1, most + 1))


def lines(first: ParameterAxis, second: ParameterAxis, second_values: Sequence[float]) -> dict[float, ParameterAxis]:
    """Return the first parameter in the system at each value of the second."""
    return {value: replace(first, system=second.system_at(value)) for value in second_values}


@lru_cache(maxsize=16)
def plate_family(first: ParameterAxis, second: ParameterAxis, second_values: tuple[float, ...]) -> PlateFamily:
    """Return the family of a pair of axes. The search takes up to a second for each value of the second parameter."""
    return PlateFamily(first, second, second_values)
