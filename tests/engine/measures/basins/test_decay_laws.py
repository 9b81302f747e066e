"""Fits of decay laws recover the law, rate and interval of random samples."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize, stats

from engine import (
    CASES,
    MapSpec,
    Plane,
    Window,
    classify_orbits,
    compute_map,
    compute_statistics,
    fit_decay_laws,
    sample_starts,
)
from engine.measures.basins.decay_laws import DecayLaw, LawFit
from engine.measures.basins.escape_statistics import MAX_SURVIVAL_POINTS, compute_survival
from engine.results import DecayLaws, EscapeStatistics

T_LOW, T_HIGH = 2.0, 1e4
KAPPA, GAMMA = 0.05, 1.5
WINDOW = (T_LOW, T_HIGH)
# A window that cuts off many later escapes.
SHORT = (T_LOW, 20.0)
SEEDS = 200
# Tolerance of exact results.
EPSILON = 1e-12
FALSE_ALARM = 1e-7
"""Probability that a test of random samples fails though the fits are correct."""
# Number of shifted grids of a map.
GRIDS = 16
DEVIATIONS = 5.5
"""Number of standard errors by which a normal variable exceeds its mean with a probability below `FALSE_ALARM`."""


def statistics_of(times: np.ndarray, *, bounded: int = 0, undecided: int = 0) -> EscapeStatistics:
    """Return statistics of a map with escapes at these times."""
    return EscapeStatistics((times.size,), bounded, undecided, 0, 0.0, 0.0, np.zeros(0, np.int64), times)


def shares_of(count: int, seed: int | None) -> np.ndarray:
    """Return random shares, or without a seed the exact quantiles of a sample."""
    return (np.arange(count) + 0.5) / count if seed is None else np.random.default_rng(seed).random(count)


def exponential_times(
    count: int, seed: int | None = None, *, window: tuple[float, float] = WINDOW, kappa: float = KAPPA
) -> np.ndarray:
    """Return times in the window that follow an exponential law."""
    low, high = window
    share = shares_of(count, seed) * -np.expm1(-kappa * (high - low))
    times: np.ndarray = low - np.log1p(-share) / kappa
    return times


def power_times(count: int, seed: int | None = None, *, window: tuple[float, float] = WINDOW, gamma: float = GAMMA) -> np.ndarray:
    """Return times in the window that follow a power law."""
    low, high = window
    share = shares_of(count, seed) * (1.0 - (high / low) ** -gamma)
    times: np.ndarray = low * (1.0 - share) ** (-1.0 / gamma)
    return times


def standard_error(fitted: LawFit) -> float:
    return (fitted.high - fitted.low) / 3.92


def both(laws: DecayLaws) -> tuple[LawFit, LawFit]:
    assert laws.exponential is not None
    assert laws.power_law is not None
    return laws.exponential, laws.power_law


def fit(times: np.ndarray, window: tuple[float, float] | None = WINDOW) -> DecayLaws:
    return fit_decay_laws(statistics_of(times), T_HIGH, window=window)


@pytest.fixture(scope="module")
def exponential() -> DecayLaws:
    return fit(exponential_times(5000))


@pytest.fixture(scope="module")
def power_law() -> DecayLaws:
    return fit(power_times(5000))


@pytest.fixture(scope="module", params=[DecayLaw.EXPONENTIAL, DecayLaw.POWER_LAW])
def many(request: pytest.FixtureRequest) -> tuple[float, list[LawFit]]:
    """Return the true rate of a law, and the fits of this law to many samples."""
    if request.param is DecayLaw.EXPONENTIAL:
        return KAPPA, [both(fit(exponential_times(200, seed, window=SHORT), SHORT))[0] for seed in range(SEEDS)]
    return GAMMA, [both(fit(power_times(200, seed)))[1] for seed in range(SEEDS)]


# Survival.


def test_survival_decreases_at_every_escape() -> None:
    times, survival = compute_survival(statistics_of(np.array([3.0, 1.0, 3.0, 2.0]), bounded=4))
    assert times.tolist() == [1.0, 2.0, 3.0]
    assert survival.tolist() == [7 / 8, 6 / 8, 4 / 8]


def test_a_long_survival_curve_is_subsampled_exactly() -> None:
    escapes = power_times(20_000)
    times, survival = compute_survival(statistics_of(escapes, bounded=100))
    assert 0.5 * MAX_SURVIVAL_POINTS < times.size <= MAX_SURVIVAL_POINTS
    assert (times[0], times[-1]) == (escapes.min(), escapes.max())
    still_inside = np.array([np.count_nonzero(escapes > t) for t in times]) + 100
    np.testing.assert_allclose(survival, still_inside / 20_100, rtol=0, atol=EPSILON)


# Rates.


@pytest.mark.parametrize("window", [WINDOW, SHORT])
@pytest.mark.parametrize("law", DecayLaw)
def test_law_and_rate_of_a_sample_are_recovered(law: DecayLaw, window: tuple[float, float]) -> None:
    is_exponential = law is DecayLaw.EXPONENTIAL
    laws = fit((exponential_times if is_exponential else power_times)(5000, window=window), window)
    fitted, rate = (laws.exponential, KAPPA) if is_exponential else (laws.power_law, GAMMA)
    assert laws.preferred is law
    assert fitted is not None
    assert fitted.rate == pytest.approx(rate, rel=2e-3)
    assert fitted.high - fitted.low < 0.3 * rate


def test_rates_maximise_the_likelihood() -> None:
    """The rates agree with a numerical maximisation of the explicit likelihoods."""
    times, (low, high) = power_times(700, window=SHORT), SHORT

    def exponential_loss(kappa: float) -> float:
        return float(-np.mean(np.log(kappa) - kappa * (times - low) - np.log(1.0 - np.exp(-kappa * (high - low)))))

    def power_loss(gamma: float) -> float:
        density = gamma * times ** (-gamma - 1.0) / (low**-gamma - high**-gamma)
        return float(-np.mean(np.log(density)))

    laws = fit(times, SHORT)
    best = [optimize.minimize_scalar(loss, bounds=(1e-3, 9.0)) for loss in (exponential_loss, power_loss)]
    assert [found.rate for found in both(laws)] == pytest.approx([result.x for result in best], rel=1e-4)
    assert laws.ratio == pytest.approx(best[1].fun - best[0].fun, abs=1e-8)


def test_increasingly_frequent_escapes_have_a_negative_rate() -> None:
    """A sample and its mirror image differ in the sign of the rate alone."""
    times = exponential_times(2000, window=SHORT)
    forward, backward = (both(fit(sample, SHORT))[0] for sample in (times, sum(SHORT) - times))
    assert (backward.low, backward.rate, backward.high) == pytest.approx((-forward.high, -forward.rate, -forward.low), rel=0.05)
    assert backward.p_value == pytest.approx(forward.p_value, rel=1e-6)


def test_bounded_orbits_do_not_affect_the_rates() -> None:
    times = power_times(400)
    alone, among_many = (fit_decay_laws(statistics_of(times, bounded=n), T_HIGH, window=WINDOW) for n in (0, 10**6))
    assert [fitted.rate for fitted in both(alone)] == [fitted.rate for fitted in both(among_many)]


def test_mirror_images_count_once() -> None:
    times = exponential_times(400)
    once, twice = fit(times), fit(np.concatenate([times, times]))
    assert twice.escapes == 400
    assert [(f.rate, f.low, f.high, f.p_value) for f in both(once)] == [(f.rate, f.low, f.high, f.p_value) for f in both(twice)]


def test_the_time_unit_scales_kappa_and_not_gamma() -> None:
    times, factor = power_times(800), 50.0
    plain = both(fit_decay_laws(statistics_of(times), T_HIGH))
    scaled = both(fit_decay_laws(statistics_of(factor * times), factor * T_HIGH))
    assert [fitted.rate for fitted in scaled] == pytest.approx([plain[0].rate / factor, plain[1].rate], rel=1e-9)
    assert scaled[1].t_low == pytest.approx(factor * plain[1].t_low)


# Intervals and p values.


def test_intervals_have_the_width_of_the_scatter_and_hold_the_rate_as_often_as_they_say(many: tuple[float, list[LawFit]]) -> None:
    rate, fits = many
    scatter = np.std([fitted.rate for fitted in fits])
    # The relative error of a standard deviation is 1 / √(2 n).
    error = DEVIATIONS / np.sqrt(2 * SEEDS)
    assert np.mean([standard_error(fitted) for fitted in fits]) / scatter == pytest.approx(1.0, abs=error)
    held = sum(fitted.low <= rate <= fitted.high for fitted in fits)
    assert stats.binomtest(held, SEEDS, 0.95).pvalue > FALSE_ALARM


def test_p_values_of_the_true_law_are_uniform(many: tuple[float, list[LawFit]]) -> None:
    assert stats.kstest([fitted.p_value for fitted in many[1]], "uniform").pvalue > FALSE_ALARM


# The choice of the window.


def test_a_chosen_window_excludes_an_early_burst() -> None:
    """Half of the escapes follow another distribution at early times."""
    held = 0
    for seed in range(20):
        burst = np.random.default_rng([seed, 1]).gamma(4.0, 1.5, 2000)
        laws = fit(np.concatenate([burst, exponential_times(2000, seed, window=(5.0, T_HIGH))]), None)
        fitted, _ = both(laws)
        held += laws.preferred is DecayLaw.EXPONENTIAL and laws.t_low > 10.0 and fitted.low <= KAPPA <= fitted.high
    # Each trial succeeds with a probability of 0.88, which includes the 0.95 of the intervals. The probability of fewer than 8
    # successes is 1e-7.
    assert held >= 8


def test_a_law_that_always_holds_is_fitted_to_the_later_half() -> None:
    laws = fit(exponential_times(2000), None)
    assert laws.escapes == pytest.approx(1000, rel=0.01)


def test_there_is_no_fit_without_a_window_in_which_a_law_holds() -> None:
    """Eight bursts, each three times later than the previous one."""
    times = np.concatenate([np.linspace(0.9, 1.0, 400) * 3.0**k for k in range(8)])
    laws = fit(times, None)
    assert (laws.exponential, laws.power_law, laws.preferred) == (None, None, None)
    assert laws.describe().startswith("No fit: neither law holds for the latest of 3 200 escapes")


# Conclusions.


def test_a_mixture_follows_neither_law() -> None:
    """The sample is a mixture of an exponential law and a power law."""
    laws = fit(np.concatenate([exponential_times(3000, kappa=0.5), power_times(1000, gamma=1.0)]))
    assert all(fitted.p_value < 0.1 for fitted in both(laws))
    assert laws.preferred is None
    assert laws.describe().startswith("Neither law holds (")


def test_uniform_escapes_do_not_decay() -> None:
    laws = fit(np.linspace(*WINDOW, 3000))
    fitted, _ = both(laws)
    assert fitted.low < 0.0 < fitted.high
    assert laws.preferred is None
    assert laws.describe().startswith("These escapes do not show a decay (")


def test_a_short_window_does_not_decide_between_the_laws() -> None:
    window = (T_LOW, 1.1 * T_LOW)
    laws = fit(exponential_times(200, window=window, kappa=10.0), window)
    assert laws.preferred is None
    assert laws.ratio_low < 0.0 < laws.ratio_high
    assert laws.describe().startswith("The data do not decide between the two laws (")


@pytest.mark.parametrize(("window", "enough"), [(WINDOW, 100), (None, 201)])
def test_a_fit_needs_100_escapes_and_twice_as_many_to_choose_a_window(window: tuple[float, float] | None, enough: int) -> None:
    none = fit(exponential_times(enough - 1), window)
    assert (none.exponential, none.power_law, none.preferred) == (None, None, None)
    assert np.isnan(none.ratio)
    assert f"{enough - 1} escapes" in none.describe()
    assert fit(exponential_times(enough), window).exponential is not None


def test_undecided_orbits_prevent_a_fit() -> None:
    laws = fit_decay_laws(statistics_of(exponential_times(500), undecided=3), T_HIGH, window=WINDOW)
    assert (laws.exponential, laws.power_law) == (None, None)
    assert "3 orbits are undecided" in laws.describe()


def test_a_map_without_escapes_has_no_law() -> None:
    laws = fit_decay_laws(statistics_of(np.zeros(0), bounded=10), T_HIGH)
    assert (laws.escapes, laws.times.size, laws.preferred) == (0, 0, None)


def test_the_exponential_is_described_with_its_interval(exponential: DecayLaws) -> None:
    fitted, _ = both(exponential)
    sentence = exponential.describe()
    assert sentence.startswith(f"Exponential: κ = {fitted.rate:.3g} ({fitted.low:.3g} to {fitted.high:.3g})")
    assert "A power law is less likely and ruled out" in sentence


@pytest.mark.parametrize(("name", "times"), [("exponential", exponential_times(5000)), ("power_law", power_times(5000))])
def test_the_curve_of_a_law_agrees_with_the_survival(name: str, times: np.ndarray) -> None:
    laws = fit_decay_laws(statistics_of(times, bounded=5000), T_HIGH, window=WINDOW)
    fitted: LawFit = getattr(laws, name)
    inside = (laws.times >= T_LOW) & (laws.times <= T_HIGH)
    assert np.max(np.abs(fitted.curve(laws.times[inside]) - laws.survival[inside])) <= 0.01
    assert fitted.curve([T_LOW, T_HIGH]).tolist() == [fitted.survival_low, fitted.survival_high] == [1.0, 0.5]
    assert np.isnan(fitted.curve([0.9 * T_LOW, 1.1 * T_HIGH])).all()


def test_t_max_is_that_of_the_map() -> None:
    statistics = compute_statistics(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.6, (60, 60), t_max=50.0)))
    assert fit_decay_laws(statistics).describe() == fit_decay_laws(statistics, 50.0).describe()
    assert fit_decay_laws(statistics, 20.0).t_high == 20.0
    with pytest.raises(ValueError, match=r"t_max=51: must be at most 50, the integration time of the statistics"):
        fit_decay_laws(statistics, 51.0)


# The dynamics.


@pytest.mark.parametrize(("energy", "earlier", "later"), [(0.2, 60.0, 200.0), (0.3, 12.0, 30.0)])
def test_the_rate_of_a_map_agrees_with_random_starts(energy: float, earlier: float, later: float) -> None:
    """The rate of hyperbolic escapes does not depend on the starts. For random starts, it is the slope of ln S."""
    laws = fit_decay_laws(compute_statistics(compute_map(MapSpec(CASES["II"], Plane.X_PX, energy, t_max=1e4))), 1e4)
    fitted, _ = both(laws)
    states = sample_starts(CASES["II"], energy, 40_000, rng=11)
    escape_time = classify_orbits(CASES["II"], energy, states, 1e3).escape_time
    # The negation also counts orbits that stay, whose escape time is NaN.
    remaining = [np.count_nonzero(~(escape_time <= t)) for t in (earlier, later)]
    slope = np.log(remaining[0] / remaining[1]) / (later - earlier)
    error = np.sqrt(1.0 / remaining[1] - 1.0 / remaining[0]) / (later - earlier)
    assert laws.preferred is DecayLaw.EXPONENTIAL
    assert fitted.rate == pytest.approx(slope, abs=DEVIATIONS * np.hypot(error, standard_error(fitted)))


def test_rates_of_shifted_grids_scatter_like_independent_samples() -> None:
    """Rates from grids that are shifted by fractions of a pixel scatter as much as the interval of a single rate says."""
    whole, side, rng = MapSpec(CASES["II"], Plane.X_PX, 0.3).find_window(), 80, np.random.default_rng(7)
    pixel = (whole.x_high - whole.x_low) / side
    fits = []
    for shift_x, shift_px in rng.uniform(0.0, pixel, (GRIDS, 2)):
        window = Window(
            whole.x_low + shift_x, whole.x_high + shift_x, whole.ordinate_low + shift_px, whole.ordinate_high + shift_px
        )
        frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (side, side), window, 1e3))
        fits.append(both(fit_decay_laws(compute_statistics(frame), 1e3, window=(12.0, 1e3)))[0])
    spread, expected = np.std([f.rate for f in fits], ddof=1), np.mean([standard_error(f) for f in fits])
    low, high = stats.chi2.ppf([0.5 * FALSE_ALARM, 1.0 - 0.5 * FALSE_ALARM], GRIDS - 1) / (GRIDS - 1)
    assert low < (spread / expected) ** 2 < high


def test_a_symmetric_map_has_half_as_many_escapes() -> None:
    statistics = compute_statistics(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.6, (100, 100), t_max=1e3)))
    laws = fit_decay_laws(statistics, 1e3, window=(0.1, 1e3))
    assert laws.escapes == statistics.escaped // 2
