"""Solutions are followed along a parameter with an adaptive step. Here a solution is the list of the values reached so far."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from engine.exits.saddle_orbits.continuation import StepLimits, follow

LIMITS = StepLimits(first=0.5, smallest=2.0**-5, attempts=50)


def reached_with(longest: Callable[[float], float]) -> list[float] | None:
    """Return the values reached from 0 up to 1, where a step from `value` can be at most `longest(value)` long."""

    def advance(values: list[float], target: float) -> list[float] | None:
        return [*values, target] if target - values[-1] <= longest(values[-1]) else None

    return follow(advance, [0.0], 0.0, 1.0, LIMITS)


def test_steps_double_after_success_and_end_at_the_last_value() -> None:
    assert reached_with(lambda _value: 1.0) == [0.0, 0.5, 1.0]


def test_steps_are_halved_where_the_solution_is_not_found() -> None:
    values = reached_with(lambda value: 0.1 if value < 0.2 else 1.0)
    assert values == pytest.approx([0.0, 0.0625, 0.125, 0.1875, 0.25, 0.375, 0.625, 1.0])


def test_a_solution_that_ceases_to_exist_on_the_way_is_not_found() -> None:
    assert reached_with(lambda value: 0.7 - value) is None


def test_the_number_of_steps_is_limited() -> None:
    assert follow(lambda value, _target: value, 0.0, 0.0, 1.0, StepLimits(1e-9, 1e-9, 3)) is None
