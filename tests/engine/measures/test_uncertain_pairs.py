"""Uncertainty exponents of maps agree with known boundaries and with independent estimates."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
import pytest

from engine import CASES
from engine.foundations.execution import Execution, SerialExecutor
from engine.maps.spec import MapSpec
from engine.measures.basins.power_law_fit import UncertaintyExponent
from engine.measures.uncertain_pairs import compute_uncertainty_exponent
from engine.slices.planes import Plane
from engine.systems.potential import Potential
from engine.trajectories.classified_orbits import classify_orbits

# x and y are uncoupled, and an orbit escapes if the energy of its motion along y exceeds 1/4. So all boundaries are smooth.
SEPARABLE = Potential("separable", ((2, 0, 0.5), (0, 2, 0.5), (0, 4, -0.25)))
HENON_HEILES = MapSpec(CASES["II"], Plane.X_PX, 0.25)


@pytest.fixture(scope="module")
def henon_heiles() -> UncertaintyExponent:
    return compute_uncertainty_exponent(HENON_HEILES, work=5e7, rng=0)


@pytest.mark.slow
def test_a_smooth_basin_boundary_has_exponent_one_and_the_correct_amplitude() -> None:
    energy = 1.0
    fit = compute_uncertainty_exponent(
        MapSpec(SEPARABLE, Plane.X_PX, energy, resolution=(10, 10), t_max=12.0), pairs=100, separations=25, rng=0
    )
    # The probability of a false alarm is 4e-8 for the exponent, and lower for the counts, which are of a hundred pairs or more.
    assert abs(fit.exponent - 1.0) < 5.5 * (fit.high - fit.low) / 3.92
    assert fit.high - fit.low < 0.2
    # A line of length L in an area S separates starts at distance ε with probability (2/π) ε L/S. Here the line is the circle
    # px² + x² = 2h − 1/2 and the area the disc px² + x² < 2h.
    radius = np.sqrt(2.0 * energy - 0.5)
    expected = 2.0 / np.pi * fit.separations * 2.0 * np.pi * radius / (2.0 * np.pi * energy)
    many = (fit.pairs * expected > 100.0) & (fit.separations < 0.1)
    deviation = (fit.uncertain - fit.pairs * expected) / np.sqrt(fit.pairs * expected)
    assert np.count_nonzero(many) >= 5
    assert np.abs(deviation[many]).max() < 6.5


def test_the_exponent_agrees_with_that_of_neighbouring_fates_along_lines(henon_heiles: UncertaintyExponent) -> None:
    """Independent estimate: the share of neighbours with different fates on fine grids along lines, against the grid step."""
    x, lines, strides = np.linspace(-0.3, 0.3, 2**13 + 1), 64, 2 ** np.arange(10)
    shares = np.zeros((lines, strides.size))
    for share, px in zip(shares, np.random.default_rng(1).uniform(-0.4, 0.4, lines), strict=True):
        states = HENON_HEILES.start_states(x, np.full(x.size, px))
        fate = classify_orbits(HENON_HEILES.potential, 0.25, states, 1000.0).fate
        share[:] = [np.mean(fate[stride:] != fate[:-stride]) for stride in strides]

    def slope_of(shares: np.ndarray) -> float:
        return float(np.polyfit(np.log(strides), np.log(shares.mean(axis=0)), 1)[0])

    # The standard error of the slope follows from leaving out one line at a time (jackknife). The probability of a false alarm is
    # 8e-7, by Student's t with 63 degrees of freedom.
    slopes = [slope_of(np.delete(shares, line, axis=0)) for line in range(lines)]
    error = np.hypot(np.sqrt(lines - 1) * np.std(slopes), (henon_heiles.high - henon_heiles.low) / 3.92)
    assert slope_of(shares) == pytest.approx(henon_heiles.exponent, abs=5.5 * error)
    assert error < 0.006


def test_separations_range_from_a_pixel_to_1e_10(henon_heiles: UncertaintyExponent) -> None:
    window = HENON_HEILES.find_window()
    assert henon_heiles.separations[0] == pytest.approx((window.x_high - window.x_low) / 224, rel=1e-12)
    assert henon_heiles.separations[-1] == pytest.approx(1e-10, rel=1e-12)


def test_only_the_seed_affects_the_result() -> None:
    def run(**options: Any) -> UncertaintyExponent:
        return compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.2), pairs=20, separations=6, **options)

    one, same, other = run(rng=0), run(rng=0, execution=Execution(SerialExecutor())), run(rng=1)
    np.testing.assert_array_equal(one.uncertain, same.uncertain)
    np.testing.assert_array_equal(one.pairs, same.pairs)
    assert one.exponent == same.exponent
    assert not np.array_equal(one.uncertain, other.uncertain)


def test_pairs_still_inside_are_counted() -> None:
    fit = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.17, t_max=200.0), pairs=50, separations=8, rng=0)
    assert fit.horizon == 200.0
    assert (fit.one_inside > 0).all()
    assert (fit.one_inside <= fit.uncertain).all()
    assert (fit.one_inside + fit.both_inside <= fit.pairs).all()


def test_below_the_escape_energy_nothing_is_uncertain() -> None:
    fit = compute_uncertainty_exponent(MapSpec(CASES["III"], Plane.X_PX, 0.2), rng=0)
    assert not fit.uncertain.any()
    np.testing.assert_array_equal(fit.both_inside, fit.pairs)
    assert "have the same fate" in fit.describe()


def test_a_cancelled_computation_raises() -> None:
    cancel, shares = threading.Event(), list[float]()

    def stop(share: float) -> None:
        shares.append(share)
        cancel.set()

    with pytest.raises(CancelledError):
        compute_uncertainty_exponent(HENON_HEILES, execution=Execution(cancel=cancel, on_progress=stop), rng=0)
    assert len(shares) == 1


def test_progress_increases_to_1() -> None:
    shares: list[float] = []
    compute_uncertainty_exponent(
        HENON_HEILES, pairs=20, separations=6, work=1e7, execution=Execution(on_progress=shares.append), rng=0
    )
    assert shares[-1] == 1.0
    assert shares == sorted(shares)
    assert len(shares) > 2
