"""The stated numbers are consistent, and include those that the paper prints."""

from __future__ import annotations

from string import Formatter

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, Window, compute_map
from reproduction.numbers.reasons import FACTS
from reproduction.numbers.stated_numbers import STATED_NUMBERS, Counting, Quantity, Relation, StatedNumber

SHARES = [number for number in STATED_NUMBERS if number.is_share]


def share_outside(number: StatedNumber, energy: float) -> float:
    """Return the share of the starts of a wide square that are outside."""
    assert number.plane is not None
    wide = compute_map(
        MapSpec(CASES[number.case], number.plane, energy, (60, 60), Window(-3.0, 3.0, -3.0, 3.0), 1e-9, use_evidence=False)
    )
    return float(np.mean(wide.fate[wide.fate != Fate.FORBIDDEN] == Fate.OUTSIDE))


def test_shares_have_valid_values_channels_and_energies() -> None:
    for number in SHARES:
        assert 0.0 <= number.value <= 100.0
        assert set(number.channels) <= set(range(1, CASES[number.case].channels + 1))
        assert min(number.energies) > CASES[number.case].escape_energy


@pytest.mark.parametrize("number", [number for number in SHARES if number.needs_window], ids=str)
def test_a_share_that_needs_a_window_has_starts_outside(number: StatedNumber) -> None:
    assert all(share_outside(number, energy) > 0.0 for energy in number.energies)


@pytest.mark.parametrize("number", [n for n in SHARES if n.counting is Counting.ANY and n.value > 0.0], ids=str)
def test_a_share_of_any_starts_has_no_starts_outside(number: StatedNumber) -> None:
    assert all(share_outside(number, energy) == 0.0 for energy in number.energies)


def test_only_shares_of_channels_name_channels() -> None:
    for number in SHARES:
        assert bool(number.channels) is (number.quantity is Quantity.ESCAPED_BY)


# Percentages as printed in the paper.
@pytest.mark.parametrize(
    ("case", "plane", "at", "quantity", "channels", "relation", "value"),
    [
        ("I", Plane.X_Y, "> 0.35", Quantity.ESCAPED_BY, (1,), Relation.ABOUT, 65.0),
        ("I", Plane.X_PX, "0.5", Quantity.ESCAPED_BY, (2,), Relation.ABOUT, 40.0),
        ("I", Plane.X_PX, "> 0.5", Quantity.DIRECT, (), Relation.MORE_THAN, 90.0),
        ("II", Plane.X_Y, "0.17", Quantity.BOUNDED, (), Relation.ABOUT, 4.0),
        ("II", Plane.X_PX, "0.17", Quantity.ESCAPED_BY, (2, 3), Relation.ABOUT, 44.0),
        ("II", Plane.X_PX, "> 0.5", Quantity.DIRECT, (), Relation.ABOUT, 80.0),
        ("III", Plane.X_Y, "0.26", Quantity.ESCAPED_BY, (4,), Relation.ABOUT, 14.0),
        ("III", Plane.X_PX, "0.6", Quantity.ESCAPED_BY, (1, 2), Relation.ABOUT, 90.0),
        ("III", Plane.X_PX, "0.26", Quantity.CHAOTIC, (), Relation.LESS_THAN, 10.0),
    ],
)  # fmt: skip
def test_printed_percentages_are_included(
    case: str, plane: Plane, at: str, quantity: Quantity, channels: tuple[int, ...], relation: Relation, value: float
) -> None:
    found = [
        number
        for number in STATED_NUMBERS
        if (number.case, number.plane, number.at, number.quantity, number.channels) == (case, plane, at, quantity, channels)
    ]
    assert [(number.relation, number.value) for number in found] == [(relation, value)]


def test_fields_of_remarks_are_known_facts() -> None:
    fields = {name for number in STATED_NUMBERS for _, name, _, _ in Formatter().parse(number.remark) if name}
    assert fields == set(FACTS)
