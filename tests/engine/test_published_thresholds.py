"""Energies and values of parameters at which something changes agree with publications; docs/thresholds.md has the table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Plane,
    Potential,
    SpecialKind,
    SweepSpec,
    System,
    classify_orbits,
    compute_exit_matching,
    continue_family,
    find_periodic_orbit,
    find_where,
    review_potential,
    sample_entrances_by_exit,
)
from engine.results import Threshold

MOON = POTENTIALS["Earth-Moon"]
MASS_RATIO = 0.0121505856


def caldera(stretch: float) -> Potential:
    """The caldera of Agaoglou et al. 2019, Chemical Reactions: A Journey into Phase Space, stretched along x."""
    return System.from_formula("5(y² + (k x)²) + 3y + 0.3((k x)⁴ + y⁴ − 6(k x)²y²); well (0, −0.3)", k=stretch).potential


@pytest.mark.parametrize(("stretch", "x"), [(1.0, 2.149), (0.8, 2.6862), (0.6, 3.5815), (0.2, 10.7446)])
def test_upper_saddles_of_the_caldera_are_those_of_the_book(stretch: float, x: float) -> None:
    potential = caldera(stretch)
    highest = max(review_potential(potential).critical_points, key=lambda point: (round(point.energy, 6), point.x))
    place = np.array([highest.x, highest.y]) + potential.origin
    assert place == pytest.approx([x, 2.0778], abs=1e-4)
    assert highest.energy == pytest.approx(27.0123, abs=1e-4)


# Szebehely & Williams 1964, Astron. J. 69, 460, table I a. Their x axis points to the larger body, and C includes m(1 − m).
@pytest.mark.parametrize(
    ("mass", "x", "constant"), [(0.10, 1.2597, 3.556684), (0.11, 1.262958, 3.579312), (0.12, 1.26557, 3.599958)]
)
def test_the_point_beyond_the_smaller_body_has_the_published_jacobi_constant(mass: float, x: float, constant: float) -> None:
    potential = System("Copenhagen", parameters={"m": mass}).potential
    outermost = max(review_potential(potential).critical_points, key=lambda point: point.x)
    assert outermost.x == pytest.approx(x, abs=1e-6)
    assert potential.jacobi_constant(outermost.energy) + mass * (1.0 - mass) == pytest.approx(constant, abs=1e-6)


@pytest.mark.parametrize(("stretch", "is_matched"), [(0.776, False), (0.780, True)])
def test_dynamical_matching_in_the_caldera_ends_at_the_stretch_of_the_book(stretch: float, is_matched: bool) -> None:
    # λ = 0.778 at h = 29. Exit 1 is over the upper right saddle, exit 3 over the lower left one.
    potential = caldera(stretch)
    entrances, starts = sample_entrances_by_exit(potential, 29.0, 200_000, rng=1)
    counts = compute_exit_matching(entrances, classify_orbits(potential, 29.0, starts, t_max=100.0)).counts
    assert counts[0].sum() > 10_000
    assert bool(counts[0, 3] == counts[0].sum()) is is_matched


def special_constants(start: list[float], until: float) -> dict[str, float]:
    """Return the Jacobi constants of the special points of a family around the Moon, which include m(1 − m)."""
    shift = MASS_RATIO * (1.0 - MASS_RATIO)
    family = continue_family(find_periodic_orbit(MOON, start, 1), MOON.jacobi_energy(until - shift))
    return {point.name: MOON.jacobi_constant(point.energy) + shift for point in family.special}


# Winter & Vieira Neto 2002, Astron. Astrophys. 393, 661, section 4, measured the islands of sections.
def test_the_distant_direct_orbit_of_the_moon_is_stable_between_the_published_jacobi_constants() -> None:
    start = [0.0914, 0.0, 0.0, 0.2457]
    assert special_constants(start, 3.18)["period doubling"] == pytest.approx(3.1820, abs=5e-5)
    assert special_constants(start, 3.196)["fold"] == pytest.approx(3.1945, abs=3e-4)


def test_the_near_direct_orbit_of_the_moon_has_no_island_below_the_published_jacobi_constant() -> None:
    constants = special_constants([0.0583, 0.0, 0.0, 0.4223], 3.196)
    assert constants["resonance 1:3"] == pytest.approx(3.1969, abs=2e-4)
    assert constants["period doubling"] == pytest.approx(3.1969, abs=5e-4)


class Loss(NamedTuple):
    """An orbit, its number of returns, and the energy above which Zotos 2014 sees no bounded starts."""

    case: str
    start: list[float]
    returns: int
    energy: float
    error: float


LOSSES = {
    # On (x, px).
    "I": Loss("I", [-0.5, 0.0, 0.0, 0.55], 1, 0.30, 3e-3),
    # On (x, h).
    "III": Loss("III", [-0.5622, 0.0, 0.0, 0.93995], 2, 0.60, 3e-4),
}


@pytest.mark.parametrize("name", LOSSES)
def test_the_last_orbit_of_a_map_loses_its_stability_where_bounded_starts_end(name: str) -> None:
    loss = LOSSES[name]
    family = continue_family(find_periodic_orbit(CASES[loss.case], loss.start, loss.returns), loss.energy + 0.01)
    doublings = [point.energy for point in family.special if point.kind is SpecialKind.DOUBLING]
    assert max(doublings) == pytest.approx(loss.energy, abs=loss.error)


def find_on_x_px(
    case: str, energies: Sequence[float] | np.ndarray, quantity: str, value: float, side: int, t_max: float
) -> Threshold:
    """Return the last energy at which a measure of maps on (x, px) reaches a value."""
    spec = SweepSpec(CASES[case], Plane.X_PX, energies, (side, side), t_max=t_max)
    return find_where(spec, quantity, value, tolerance=1e-3, last=True)


# Zotos 2014 has islands at the first energy and none at the second, among those of his figures on (x, px).
@pytest.mark.parametrize(
    ("case", "searched", "seen", "unseen"),
    [("II", np.linspace(0.18, 0.25, 8), 0.20, 0.22), ("III", np.linspace(0.5, 0.65, 7), 0.55, 0.60)],
    ids=["II", "III"],
)
def test_the_last_island_vanishes_between_the_energies_of_the_figures(
    case: str, searched: np.ndarray, seen: float, unseen: float
) -> None:
    found = find_on_x_px(case, searched, "islands", 0.5, 225, 1e4)
    assert seen < found.low < found.high < unseen


def test_direct_escapes_reach_a_share_where_the_fit_of_the_paper_does() -> None:
    # 0.9 = −1.496 + 7.585 h − 5.938 h².
    assert find_on_x_px("III", (0.4, 0.7), "direct_share", 0.9, 100, 1e3).estimate == pytest.approx(0.5723, abs=0.003)


@pytest.mark.slow
def test_half_of_the_starts_escape_where_the_fit_of_the_paper_says() -> None:
    # ½ = ½ [1 + tanh(15.85 h − 4.93)].
    assert find_on_x_px("III", (0.26, 0.6), "share_bounded", 0.5, 100, 1e4).estimate == pytest.approx(0.3110, abs=0.008)


@pytest.mark.slow
def test_nine_tenths_of_the_starts_escape_at_the_energies_of_the_paper() -> None:
    found = find_on_x_px("III", (0.26, 0.6), "share_bounded", 0.1, 100, 1e4)
    assert 0.40 < found.low < found.high < 0.45
