"""Reduced histories look like the curve, and where the curve oscillates too fast, they are its envelope and mean."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, integrate_orbit
from plots.pictures.histories import History, reduce_history
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES

TIMES = np.linspace(0.02, 1e4, 400_000)


@pytest.fixture(scope="module")
def oscillation() -> History:
    return reduce_history(TIMES, 1.0 + np.cos(2.0 * TIMES), logarithmic=False)


def test_early_oscillations_are_drawn_themselves(oscillation: History) -> None:
    times, values = oscillation.line
    early = times < 10.0
    np.testing.assert_array_equal(values[early], 1.0 + np.cos(2.0 * times[early]))
    assert (np.ptp(values[early]), oscillation.band[0].min() > 10.0) == (pytest.approx(2.0, abs=1e-3), True)


def test_oscillations_of_a_short_orbit_are_drawn_to_its_end() -> None:
    short = TIMES < 500.0
    history = reduce_history(TIMES[short], 1.0 + np.cos(TIMES[short]), logarithmic=False)
    assert history.band[0].size == 0
    times, values = history.line
    assert np.ptp(values[times > 490.0]) == pytest.approx(2.0, abs=1e-2)


def test_late_oscillations_are_an_envelope_with_its_mean(oscillation: History) -> None:
    times, low, high = oscillation.band
    late = times > 500.0
    np.testing.assert_allclose(low[late], 0.0, atol=1e-3)
    np.testing.assert_allclose(high[late], 2.0, atol=1e-3)
    np.testing.assert_allclose(oscillation.line[1][oscillation.line[0] > 500.0], 1.0, atol=0.1)


def test_a_history_has_few_points_and_its_whole_duration(oscillation: History) -> None:
    times = oscillation.line[0]
    assert times.size < 6000
    assert (times[0], times[-1], oscillation.band[0][-1]) == (TIMES[0], TIMES[-1], TIMES[-1])
    assert np.all(np.diff(times) > 0.0)


def test_each_orbit_is_reduced_over_its_own_time() -> None:
    """The early oscillations of a long orbit are drawn like those of a short orbit in the same plot."""
    potential, bounded, escaping = CASES["I"], (-0.46, 0.0, 0.0, 0.2), (0.1, 0.0, 0.05, 0.6)
    for state, t_max in ((bounded, 2e4), (escaping, 2e4)):
        curves = compute_orbit_curves(potential, integrate_orbit(potential, state, t_max))
        times, values = curves.histories["r2"].line
        assert times[-1] == curves.orbit.t[-1]
        early = times < min(15.0, float(times[-1]))
        np.testing.assert_array_equal(values[early], curves.orbit.r2[np.searchsorted(curves.orbit.t, times[early])])
        assert np.diff(times[early]).max() < 0.3


def test_the_axis_of_exponents_has_room_for_the_smallest_one() -> None:
    (exponent,) = (quantity for quantity in ORBIT_QUANTITIES if quantity.name == "exponent")
    low, high = (History((np.array([1.0, 2.0]), np.array([0.5, last])), (np.zeros(0),) * 3) for last in (0.003, 0.2))
    assert exponent.limits([low, high])[0] == exponent.limits([high, low])[0] == pytest.approx(1e-3)
