from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
import pytest

from engine.basins.uncertainty_exponent import UncertaintyExponent, compute_uncertainty_exponent, fit_uncertainty
from engine.dynamics.classification import classify_orbits
from engine.dynamics.planes import Plane, Window
from engine.execution import SerialExecutor
from engine.maps.spec import MapSpec
from engine.potentials.potential import CASES, Potential

SEPARATIONS = np.geomspace(1e-2, 1e-10, 17)
# Motions along x and y are independent, and y alone decides who leaves: when py²/2 > 1/4, up; so all boundaries are smooth.
SEPARABLE = Potential("separable", ((2, 0, 0.5), (0, 2, 0.5), (0, 4, -0.25)))
HENON_HEILES = MapSpec(CASES["II"], Plane.X_PX, 0.25)


def law(alpha: float, amplitude: float, bend_at: float = np.inf) -> np.ndarray:
    """Shares A ε^α, which saturate above `bend_at`."""
    return amplitude * SEPARATIONS**alpha / (1.0 + SEPARATIONS / bend_at) ** alpha


def counts(random: np.random.Generator, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """So many pairs that about 200 are uncertain at each separation."""
    pairs = np.clip(200.0 / share, 200.0, 2e5).astype(int)
    return SEPARATIONS, pairs, random.binomial(pairs, share)


def coverage(trials: int, alpha: float, shares: Callable[[np.random.Generator], np.ndarray]) -> float:
    """How often the interval holds the exponent, when there is one, which must be nearly always."""
    random = np.random.default_rng(3)
    fits = [fit_uncertainty(*counts(random, shares(random))) for _ in range(trials)]
    held = [fit.low <= alpha <= fit.high for fit in fits if np.isfinite(fit.exponent)]
    assert len(held) > 0.85 * trials
    return float(np.mean(held))


def fit_set(label: Callable[[np.ndarray], np.ndarray], pairs: int, smallest: float = 1e-9) -> UncertaintyExponent:
    """The exponent of a labelled interval [0, 1], from random pairs of points."""
    random = np.random.default_rng(5)
    separations = np.geomspace(1e-2, smallest, 15)
    points = random.uniform(0.0, 1.0, (separations.size, pairs))
    uncertain = (label(points) != label(points + separations[:, None])).sum(axis=1)
    return fit_uncertainty(separations, np.full(separations.size, pairs), uncertain)


def gap_of_cantor_set(x: np.ndarray) -> np.ndarray:
    """The step at which the middle-thirds construction takes a point of [0, 1] out, modulo 3; 40 stands for never."""
    step = np.full(x.shape, 40)
    for number in range(40):
        x = 3.0 * x
        step[(x > 1.0) & (x < 2.0) & (step == 40)] = number
        x = x - np.floor(np.minimum(x, 2.0))
    return step % 3


def test_an_exact_law_is_found_again() -> None:
    fit = fit_uncertainty(SEPARATIONS, np.full(17, 10**12), np.rint(1e12 * law(0.3, 0.5)).astype(int))
    assert fit.exponent == pytest.approx(0.3, abs=1e-5)
    assert fit.amplitude == pytest.approx(0.5, rel=1e-4)
    assert fit.dimension == pytest.approx(1.7, abs=1e-5)


def test_the_likelihood_has_its_summit_at_the_exponent() -> None:
    fit = fit_uncertainty(*counts(np.random.default_rng(0), law(0.2, 0.5)))
    n, k, x = (array[fit.used] for array in (fit.pairs, fit.uncertain, np.log(fit.separations)))
    share = fit.amplitude * np.exp(fit.exponent * x)
    score = (k - n * share) / (1.0 - share)
    assert np.abs(score.sum()) < 1e-3 * np.abs(score).sum()
    assert np.abs((score * x).sum()) < 1e-3 * np.abs(score * x).sum()


def test_the_boundary_of_the_cantor_set_has_its_dimension() -> None:
    fit = fit_set(gap_of_cantor_set, 20_000)
    known = 1.0 - np.log(2.0) / np.log(3.0)
    assert fit.low <= known <= fit.high
    assert fit.high - fit.low < 0.05


def test_a_smooth_boundary_has_exponent_one() -> None:
    fit = fit_set(lambda x: np.floor(10.0 * x), 100_000, smallest=1e-5)
    assert fit.low <= 1.0 <= fit.high
    assert fit.high - fit.low < 0.2


@pytest.mark.parametrize("alpha", [0.02, 0.15, 0.35])
def test_the_interval_holds_the_exponent_in_95_of_100(alpha: float) -> None:
    assert 0.92 <= coverage(200, alpha, lambda random: law(alpha, 0.6)) <= 0.995


def test_the_interval_holds_it_though_shares_scatter() -> None:
    assert coverage(150, 0.2, lambda random: law(0.2, 0.5) * np.exp(0.08 * random.normal(size=17))) > 0.85


@pytest.mark.parametrize("bend_at", [1e-2, 1e-4])
def test_the_interval_holds_it_though_shares_saturate(bend_at: float) -> None:
    assert coverage(100, 0.25, lambda random: law(0.25, 2.0, bend_at)) > 0.9


def test_saturated_separations_are_left_out() -> None:
    fit = fit_uncertainty(*counts(np.random.default_rng(0), law(0.25, 2.0, 1e-4)))
    assert not fit.used[SEPARATIONS > 1e-4].any()
    assert fit.used[SEPARATIONS < 1e-6].all()


def test_separations_with_too_few_uncertain_pairs_are_left_out() -> None:
    share = law(0.3, 0.9)
    pairs = np.full(17, 2000)
    fit = fit_uncertainty(SEPARATIONS, pairs, np.random.default_rng(0).binomial(pairs, share))
    assert not fit.used[pairs * share < 3.0].any()
    assert fit.used[(pairs * share > 8.0) & (SEPARATIONS < 1e-4)].all()


def test_shares_that_bend_everywhere_have_no_exponent() -> None:
    share = 0.3 * np.exp(-(np.log(SEPARATIONS / 1e-2) ** 2) / 60.0)
    fit = fit_uncertainty(SEPARATIONS, np.full(17, 10**7), np.rint(1e7 * share).astype(int))
    assert np.isnan([fit.exponent, fit.low, fit.high, fit.amplitude, fit.dimension]).all()
    assert fit.describe().startswith("No uncertainty exponent: no power law describes")


def test_shares_that_jump_about_have_no_exponent() -> None:
    share = law(0.2, 0.5) * np.exp(0.5 * (-1.0) ** np.arange(17))
    fit = fit_uncertainty(SEPARATIONS, np.full(17, 10**5), np.rint(1e5 * share).astype(int))
    assert np.isnan(fit.exponent)
    assert fit.misfit > 10.0
    assert fit.probability < 1e-6


@pytest.mark.parametrize(
    ("pairs", "uncertain", "sentence"),
    [
        (np.full(17, 100), np.zeros(17, int), "both orbits of every one of the 1700 pairs have the same fate"),
        (np.zeros(17, int), np.zeros(17, int), "no pair of starts lies inside"),
        (np.full(17, 100), np.arange(17)[::-1] // 5, "are too few, or over too short a range of separations"),
        (np.full(17, 100), np.full(17, 100), "are too few, or over too short a range of separations"),
    ],
)
def test_what_stands_in_the_way_is_said(pairs: np.ndarray, uncertain: np.ndarray, sentence: str) -> None:
    fit = fit_uncertainty(SEPARATIONS, pairs, uncertain)
    assert np.isnan(fit.exponent)
    assert sentence in fit.describe()


def test_the_sentence_has_the_digits_that_the_interval_leaves() -> None:
    def described(exponent: float, low: float, high: float) -> str:
        arrays = (np.array([1e-2, 1e-9]), np.full(2, 9), np.full(2, 5), np.full(2, True))
        return UncertaintyExponent(*arrays, exponent, low, high, amplitude=1.0, misfit=1.0).describe()

    assert described(0.3123, 0.2912, 0.3345) == (
        "α = 0.31 (0.29 to 0.33), so the boundary has dimension 1.69, at separations from 1e-09 to 1e-02."
    )
    assert described(0.004, -0.003, 0.011) == (
        "α = 0.004 (−0.003 to 0.011), so the boundary has dimension 1.996, at separations from 1e-09 to 1e-02; "
        "one that fills the plane, α = 0, would do as well."
    )
    assert described(0.93, 0.8, 1.06).endswith("; a smooth boundary, α = 1, would do as well.")


def test_the_order_of_separations_does_not_matter() -> None:
    found = counts(np.random.default_rng(0), law(0.2, 0.5))
    mixed = np.random.default_rng(1).permutation(17)
    fit, other = fit_uncertainty(*found), fit_uncertainty(*(array[mixed] for array in found))
    assert other.exponent == pytest.approx(fit.exponent, rel=1e-6)
    np.testing.assert_array_equal(other.used, fit.used[mixed])


def test_shares_are_those_of_the_pairs() -> None:
    fit = fit_uncertainty([1e-2, 1e-3], [0, 8], [0, 2])
    np.testing.assert_array_equal(fit.shares, [np.nan, 0.25])


def test_arrays_are_read_only_and_counted() -> None:
    fit = fit_uncertainty(*counts(np.random.default_rng(0), law(0.2, 0.5)))
    assert not any(array.flags.writeable for array in (fit.separations, fit.pairs, fit.uncertain, fit.used))
    assert fit.nbytes == 17 * (8 + 8 + 8 + 1)


@pytest.mark.parametrize(
    ("separations", "pairs", "uncertain", "message"),
    [
        ([1e-2, 0.0], [1, 1], [0, 0], "separations=.* above 0"),
        ([1e-2, 1e-2], [1, 1], [0, 0], "separations=.* different"),
        ([1e-2, np.inf], [1, 1], [0, 0], "separations=.* finite"),
        ([1e-2, 1e-3], [1, 1, 1], [0, 0], "pairs=.* as many as separations, 2"),
        ([1e-2, 1e-3], [1, 1], [0.5, 0.0], "uncertain=.* integers"),
        ([1e-2, 1e-3], [1, 1], [0, 2], "uncertain=.* from 0 to pairs"),
        ([1e-2, 1e-3], [1, 1], [-1, 0], "uncertain=.* from 0 to pairs"),
    ],
)
def test_counts_that_cannot_be_are_refused(separations: Any, pairs: Any, uncertain: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit_uncertainty(separations, pairs, uncertain)


@pytest.fixture(scope="module")
def henon_heiles() -> UncertaintyExponent:
    return compute_uncertainty_exponent(HENON_HEILES)


def test_a_smooth_boundary_of_the_dynamics_has_exponent_one_and_its_length() -> None:
    energy = 1.0
    fit = compute_uncertainty_exponent(
        MapSpec(SEPARABLE, Plane.X_PX, energy, resolution=(10, 10), t_max=12.0), pairs=100, separations=25
    )
    assert fit.low <= 1.0 <= fit.high
    assert fit.high - fit.low < 0.2
    # A line of length L in an area S parts starts ε apart with probability (2/π) ε L/S: circles px² + x² = 2h − 1/2 in 2h.
    radius = np.sqrt(2.0 * energy - 0.5)
    expected = 2.0 / np.pi * fit.separations * 2.0 * np.pi * radius / (2.0 * np.pi * energy)
    many = (fit.pairs * expected > 20.0) & (fit.separations < 0.1)
    deviation = (fit.uncertain - fit.pairs * expected) / np.sqrt(fit.pairs * expected)
    assert np.count_nonzero(many) >= 5
    assert np.abs(deviation[many]).max() < 3.5


def test_it_agrees_with_the_count_of_fates_along_lines(henon_heiles: UncertaintyExponent) -> None:
    """The share of neighbours with different fates on a fine grid along a line, against its step, is a second opinion."""
    x = np.linspace(-0.3, 0.3, 2**15 + 1)
    strides = 2 ** np.arange(10)
    shares = np.zeros((4, strides.size))
    for share, px in zip(shares, [-0.22, -0.07, 0.12, 0.31], strict=True):
        states = HENON_HEILES.start_states(x, np.full(x.size, px))
        fate = classify_orbits(HENON_HEILES.potential, 0.25, states, 1000.0).fate
        share[:] = [np.mean(fate[stride:] != fate[:-stride]) for stride in strides]
    slope = np.polyfit(np.log(strides), np.log(shares.mean(axis=0)), 1)[0]
    assert slope == pytest.approx(henon_heiles.exponent, abs=0.03)


def test_it_agrees_with_the_line_px_0_of_the_same_energy(henon_heiles: UncertaintyExponent) -> None:
    """On (x, h) starts are displaced along x alone; a line across the boundary loses one dimension, and α stays."""
    spec = MapSpec(CASES["II"], Plane.X_H, (0.2499, 0.2501), resolution=(225, 3))
    line = compute_uncertainty_exponent(spec, separations=9)
    assert line.low - 0.02 < henon_heiles.exponent < line.high + 0.02


@pytest.mark.parametrize(("plane", "backward"), [(Plane.X_PX, True), (Plane.X_Y, False)])
def test_the_past_and_another_plane_have_the_same_exponent(
    plane: Plane, backward: bool, henon_heiles: UncertaintyExponent
) -> None:
    """(x, px) → (x, −px) carries basins of exit into basins of entry; planes cut the same manifolds."""
    other = compute_uncertainty_exponent(MapSpec(CASES["II"], plane, 0.25, backward=backward), separations=9, seed=1)
    width = np.hypot(other.high - other.low, henon_heiles.high - henon_heiles.low)
    assert abs(other.exponent - henon_heiles.exponent) < width


def test_near_the_escape_energy_the_boundary_nearly_fills_the_plane(henon_heiles: UncertaintyExponent) -> None:
    near = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.17), pairs=100)
    assert near.dimension > 1.97 > henon_heiles.dimension
    assert 1.74 < henon_heiles.dimension < 1.79


def test_separations_reach_from_a_pixel_to_1e_10(henon_heiles: UncertaintyExponent) -> None:
    window = HENON_HEILES.window
    assert henon_heiles.separations[0] == pytest.approx((window.x_high - window.x_low) / 225, rel=1e-12)
    assert henon_heiles.separations[-1] == pytest.approx(1e-10, rel=1e-12)


def test_in_a_deep_zoom_they_reach_four_decades_below_a_pixel() -> None:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.25, resolution=(10, 20), window=Window(0.1, 0.1 + 1e-7, 0.1, 0.1 + 1e-7))
    separations = compute_uncertainty_exponent(spec, pairs=10).separations
    np.testing.assert_allclose(separations[[0, -1]], [5e-9, 5e-13], rtol=1e-6)


def test_where_few_are_uncertain_more_pairs_are_followed(henon_heiles: UncertaintyExponent) -> None:
    assert (henon_heiles.pairs >= 200).all()
    assert henon_heiles.pairs[-1] > 20 * henon_heiles.pairs[0]
    assert henon_heiles.uncertain.min() > 100


def test_the_seed_decides_and_nothing_else() -> None:
    def run(**options: Any) -> UncertaintyExponent:
        return compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.2), pairs=20, separations=6, **options)

    one, same, other = run(), run(executor=SerialExecutor()), run(seed=1)
    np.testing.assert_array_equal(one.uncertain, same.uncertain)
    np.testing.assert_array_equal(one.pairs, same.pairs)
    assert one.exponent == same.exponent
    assert not np.array_equal(one.uncertain, other.uncertain)


def test_pairs_still_inside_are_counted() -> None:
    fit = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.17, t_max=200.0), pairs=50, separations=8)
    assert fit.horizon == 200.0
    assert (fit.one_inside > 0).all()
    assert (fit.one_inside <= fit.uncertain).all()
    assert (fit.one_inside + fit.both_inside <= fit.pairs).all()


def test_a_longer_time_lets_more_leave() -> None:
    def inside(t_max: float) -> float:
        fit = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.18, t_max=t_max), pairs=50, separations=6)
        return float(np.sum(fit.one_inside + fit.both_inside) / fit.pairs.sum())

    assert inside(100.0) > inside(1000.0) > 0.0


def test_below_the_escape_energy_nothing_is_uncertain() -> None:
    fit = compute_uncertainty_exponent(MapSpec(CASES["III"], Plane.X_PX, 0.2))
    assert not fit.uncertain.any()
    np.testing.assert_array_equal(fit.both_inside, fit.pairs)
    assert "have the same fate" in fit.describe()


def test_a_window_without_interior_has_no_pairs() -> None:
    fit = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.25, window=Window(0.0, 1.0, 3.0, 4.0)))
    assert not fit.pairs.any()
    assert "no pair of starts lies inside" in fit.describe()


def test_progress_rises_to_one() -> None:
    shares: list[float] = []
    compute_uncertainty_exponent(HENON_HEILES, pairs=20, separations=6, on_progress=shares.append)
    assert shares[-1] == 1.0
    assert shares == sorted(shares)
    assert len(shares) > 2


def test_when_cancelled_it_says_so() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_uncertainty_exponent(HENON_HEILES, cancel=cancel)


def test_it_can_be_cancelled_on_the_way() -> None:
    cancel, shares = threading.Event(), list[float]()

    def stop(share: float) -> None:
        shares.append(share)
        cancel.set()

    with pytest.raises(CancelledError):
        compute_uncertainty_exponent(HENON_HEILES, on_progress=stop, cancel=cancel)
    assert len(shares) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pairs": 9}, "pairs=9: must be an integer from 10 to 100000"),
        ({"pairs": 20.5}, "pairs=20.5: must be an integer"),
        ({"separations": 4}, "separations=4: must be an integer from 5 to 100"),
        ({"seed": -1}, "seed=-1: must be an integer from 0"),
    ],
)
def test_parameters_out_of_range_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        compute_uncertainty_exponent(HENON_HEILES, **options)


def test_pixels_without_room_below_them_are_refused() -> None:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.25, resolution=(10, 10), window=Window(0.1, 0.1 + 1e-11, 0.1, 0.1 + 1e-11))
    with pytest.raises(ValueError, match=r"window=.*double precision ends here"):
        compute_uncertainty_exponent(spec)
