"""Orbits that graze y = 0 have two crossings, or none, within a small part of one step.

In the cases of the paper, an orbit with y = ẏ = 0 stays on y = 0. In a potential that is not even in y, an orbit can turn at
y = 0. Each start is computed backward in time by heyoka, from a turning point at a small depth beyond or before y = 0.
"""

from __future__ import annotations

import numpy as np
import pytest

from engine import Potential, classify_orbits
from tests.peers import taylor_heyoka

ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))
TIME_TO_TURN, T_MAX = 3.0, 6.0
DEPTHS = [1e-3, 1e-9]


def grazing_starts(y_at_turn: float) -> np.ndarray:
    x, px = np.random.default_rng(14).uniform(-0.45, 0.45, (2, 60))
    turning = np.column_stack([x, np.full(60, y_at_turn), px, np.zeros(60)])
    # An orbit turns only if ÿ = −V_y is not close to 0.
    turning = turning[np.abs(ODD.gradient(x, 0 * x)[1]) > 0.01]
    return taylor_heyoka.propagated(ODD, turning, -TIME_TO_TURN)


def crossings(starts: np.ndarray, t_max: float = T_MAX) -> np.ndarray:
    """Return the crossings of orbits, which are classified one by one because each has its own energy."""
    energies = ODD.energy(starts)
    assert energies.max() < ODD.escape_energy
    return np.array([classify_orbits(ODD, h, s[None], t_max).crossings[0] for h, s in zip(energies, starts, strict=True)])


# At a depth of 1e-3 the two orbits also differ elsewhere.
@pytest.mark.parametrize("depth", DEPTHS[1:])
def test_turning_beyond_zero_changes_the_count_by_one(depth: float) -> None:
    above, below = crossings(grazing_starts(depth)), crossings(grazing_starts(-depth))
    assert above.size > 30
    # Exactly one of the two orbits crosses y = 0 and returns, whether it comes from above or from below.
    np.testing.assert_array_equal(np.abs(above - below), 1)


@pytest.mark.parametrize("depth", [sign * depth for depth in DEPTHS for sign in (-1, 1)])
def test_crossings_agree_with_heyoka(depth: float) -> None:
    starts = grazing_starts(depth)
    np.testing.assert_array_equal(crossings(starts), taylor_heyoka.classify(ODD, [], starts, T_MAX).crossings)


def test_crossings_of_long_orbits_agree_with_heyoka() -> None:
    starts = np.random.default_rng(15).uniform(-0.25, 0.25, (60, 4))
    counts = crossings(starts, 150.0)
    assert counts.sum() > 1000
    np.testing.assert_array_equal(counts, taylor_heyoka.classify(ODD, [], starts, 150.0).crossings)
