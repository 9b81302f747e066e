"""The nearest divergent start has another fate, and no nearer start has."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from engine import CASES, Fate, Plane, classify_orbits, find_divergent_start, integrate_orbit, start_states
from engine.results import DivergentStart

T_MAX = 2000.0
# Potential, plane, energy, x and ordinate of starts at different distances from the basin boundary. The first orbit escapes at
# t = 1377, and the nearest divergent orbits later than t = 1000. The second orbit is bounded.
STARTS = [
    ("I", Plane.X_PX, 0.15, -0.22, 0.07),
    ("III", Plane.X_Y, 0.5, 0.2, 0.3),
    ("II", Plane.X_PX, 0.22, 0.3, 0.05),
    ("II", Plane.X_H, (0.2, 0.4), -0.2, 0.25),
]


def find(name: str, plane: Plane, energy: Any, x: float, ordinate: float, **options: Any) -> DivergentStart | None:
    return find_divergent_start(CASES[name], plane, energy, x, ordinate, T_MAX, **options)


def find_existing(*start: Any, **options: Any) -> DivergentStart:
    divergent = find(*start, **options)
    assert divergent is not None
    return divergent


def fate_of(name: str, plane: Plane, energy: Any, x: float, ordinate: float) -> int:
    state = start_states(CASES[name], plane, energy, np.array([x]), np.array([ordinate]))[0]
    return integrate_orbit(CASES[name], state, T_MAX).fate


@cache
def divergent_of(start: tuple[Any, ...]) -> DivergentStart:
    return find_existing(*start)


@pytest.mark.parametrize("start", STARTS, ids=str)
def test_the_divergent_start_escapes_through_another_channel(start: tuple[Any, ...]) -> None:
    divergent = divergent_of(start)
    if start[1] is Plane.X_H:
        assert divergent.ordinate == start[4]
    assert divergent.reference_fate == fate_of(*start)
    assert divergent.fate == fate_of(*start[:3], divergent.x, divergent.ordinate)
    assert divergent.fate >= 1
    assert divergent.fate != divergent.reference_fate


@pytest.mark.parametrize("start", [start for start in STARTS if start[1] is not Plane.X_H], ids=str)
def test_no_start_at_half_the_distance_diverges(start: tuple[Any, ...]) -> None:
    name, plane, energy, x, ordinate = start
    divergent, angle = divergent_of(start), np.pi / 8 * np.arange(16)
    near = 0.5 * divergent.distance
    around = start_states(CASES[name], plane, energy, x + near * np.cos(angle), ordinate + near * np.sin(angle))
    assert set(classify_orbits(CASES[name], energy, around, T_MAX).fate) <= {divergent.reference_fate, Fate.BOUNDED}


def test_mirror_images_have_equal_distances() -> None:
    one = find_existing("III", Plane.X_PX, 0.35, 0.1, 0.3)
    other = find_existing("III", Plane.X_PX, 0.35, -0.1, -0.3)
    assert one.distance == other.distance
    assert (1, 0, 3, 2)[one.reference_fate - 1] + 1 == other.reference_fate
