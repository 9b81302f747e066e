"""Orbits that touch y = 0 and turn back: two crossings, or none, within a sliver of one step.

The paper's cases keep y = 0 for ever once y = ẏ = 0; a potential that is not even in y lets an orbit turn there. Each orbit is
made from its turning point, a depth beyond or short of y = 0, carried back in time by heyoka.
"""

from __future__ import annotations

import numpy as np
import pytest

from engine import Potential, classify_orbits
from tests.peers import dop853, taylor_heyoka

ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))
BEFORE, T_MAX = 3.0, 6.0
DEPTHS = [1e-3, 1e-5, 1e-7, 1e-9]


def grazing_starts(y_at_turn: float) -> np.ndarray:
    x, px = np.random.default_rng(14).uniform(-0.45, 0.45, (2, 60))
    turning = np.column_stack([x, np.full(60, y_at_turn), px, np.zeros(60)])
    # ÿ = −V_y well away from 0, so that the turn is a turn.
    turning = turning[np.abs(ODD.gradient(x, 0 * x)[1]) > 0.01]
    return taylor_heyoka.propagated(ODD, turning, -BEFORE)


def crossings(starts: np.ndarray, t_max: float = T_MAX) -> np.ndarray:
    """One list for each orbit, since each has its own energy."""
    energies = ODD.energy(starts)
    assert energies.max() < ODD.escape_energy
    return np.array([classify_orbits(ODD, h, s[None], t_max).crossings[0] for h, s in zip(energies, starts, strict=True)])


# At a depth of 1e-3 the two orbits already differ elsewhere.
@pytest.mark.parametrize("depth", DEPTHS[1:])
def test_turning_beyond_zero_is_one_crossing_more_than_turning_short_of_it(depth: float) -> None:
    above, below = crossings(grazing_starts(depth)), crossings(grazing_starts(-depth))
    assert above.size > 30
    # Whether the orbit comes from above or from below, exactly one of the two touches y = 0 from the far side.
    np.testing.assert_array_equal(np.abs(above - below), 1)


@pytest.mark.parametrize("depth", [sign * depth for depth in DEPTHS for sign in (-1, 1)])
def test_heyoka_counts_the_same(depth: float) -> None:
    starts = grazing_starts(depth)
    np.testing.assert_array_equal(crossings(starts), taylor_heyoka.classify(ODD, [], starts, T_MAX).crossings)


@pytest.mark.parametrize("depth", [-1e-3, 1e-3])
def test_scipy_counts_the_same(depth: float) -> None:
    # Dense sampling every 0.008 sees dips of 1e-3 but none much shallower.
    starts = grazing_starts(depth)
    np.testing.assert_array_equal(crossings(starts), dop853.classify(ODD, [], starts, T_MAX).crossings)


def test_long_orbits_that_graze_now_and_then_are_counted_alike() -> None:
    starts = np.random.default_rng(15).uniform(-0.25, 0.25, (60, 4))
    counts = crossings(starts, 150.0)
    assert counts.sum() > 1000
    np.testing.assert_array_equal(counts, taylor_heyoka.classify(ODD, [], starts, 150.0).crossings)
