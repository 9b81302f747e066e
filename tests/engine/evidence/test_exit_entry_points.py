"""Orbits through the entry points of an exit have entered through this exit."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, classify_orbits, start_states
from engine.evidence.exit_entry_points import find_entry_points

ENERGIES = [("I", 0.13), ("I", 0.4), ("II", 0.17), ("II", 0.4), ("III", 0.26), ("III", 0.6)]


@pytest.mark.parametrize(("name", "energy"), ENERGIES)
def test_orbits_through_entry_points_entered_through_their_exit(name: str, energy: float) -> None:
    """H is even in the momenta, so orbits backward in time are orbits forward with reversed momenta."""
    for channel, points in enumerate(find_entry_points(CASES[name], energy), start=1):
        states = start_states(CASES[name], Plane.X_PX, energy, *points.T)
        states = states[np.isfinite(states).all(axis=1)]
        assert len(states) > 0
        outcome = classify_orbits(CASES[name], energy, states * [1.0, 1.0, -1.0, -1.0], 40.0)
        assert set(outcome.fate.tolist()) == {channel}


def test_there_are_no_entry_points_below_the_escape_energy() -> None:
    assert find_entry_points(CASES["I"], 0.1) == ()
