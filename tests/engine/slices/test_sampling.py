"""Random starts cover the energy surface, or a window, uniformly."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from engine import CASES, Plane, Slice, sample_starts
from engine.exits.interior import find_outside_channels

# Probability that a test of correct starts fails.
FALSE_ALARM = 1e-6


@pytest.mark.parametrize("plane", [None, Plane.X_PX, Plane.TANGENTIAL])
def test_starts_have_the_energy_and_are_inside(plane: Slice | None) -> None:
    name = "II"
    starts = sample_starts(CASES[name], 0.4, 500, plane=plane, rng=0)
    np.testing.assert_allclose(CASES[name].energy(starts), 0.4, atol=1e-14)
    assert starts.shape == (500, 4)
    assert not find_outside_channels(CASES[name], 0.4, *np.ascontiguousarray(starts[:, :2].T)).any()


def test_the_energy_surface_is_covered_uniformly() -> None:
    potential, energy = CASES["III"], 0.4
    starts = sample_starts(potential, energy, 20_000, rng=3)
    # Expected shares of the quadrants, from a grid of points inside, and of the directions of the velocity.
    side = np.linspace(-1.6, 1.6, 801)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    inside = (potential.value(x, y) <= energy) & (find_outside_channels(potential, energy, x, y) == 0)
    near = np.hypot(x, y)[inside] < 0.5
    assert stats.binomtest(int((np.hypot(*starts[:, :2].T) < 0.5).sum()), 20_000, near.mean()).pvalue > FALSE_ALARM
    angle = np.arctan2(starts[:, 3], starts[:, 2])
    assert stats.kstest(angle, stats.uniform(-np.pi, 2 * np.pi).cdf).pvalue > FALSE_ALARM


def test_a_generator_continues_and_none_gives_new_starts() -> None:
    def draw(rng: np.random.Generator | int | None) -> np.ndarray:
        return sample_starts(CASES["II"], 0.2, 50, rng=rng)

    generator = np.random.default_rng(1)
    np.testing.assert_array_equal(draw(generator), draw(1))
    assert not np.array_equal(draw(generator), draw(1))
    assert not np.array_equal(draw(None), draw(None))


def test_equal_seeds_give_equal_starts() -> None:
    one, same, other = (sample_starts(CASES["II"], 0.2, 50, rng=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert np.any(one != other)


def test_starts_are_in_the_window() -> None:
    starts = sample_starts(CASES["I"], 0.2, 300, plane=Plane.X_PX, window=(0.1, 0.2, -0.3, 0.0), rng=0)
    assert np.all((starts[:, 0] > 0.1) & (starts[:, 0] < 0.2) & (starts[:, 2] > -0.3) & (starts[:, 2] < 0.0))
