"""Every public result is the same in other units: under x → L x, V → E V and m → M m, times scale as L √(M/E).

With L a power of 2, and E and M powers of 4, all conversions are exact, and so must be the results.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    Fate,
    LyapunovOrbit,
    MapSpec,
    Orbit,
    Plane,
    Potential,
    Trust,
    compute_map,
    compute_regularity,
    compute_separation,
    compute_trust,
    compute_uncertainty_exponent,
    find_divergent_start,
    find_lyapunov_orbits,
    find_stable_manifolds,
    integrate_orbit,
    judge_orbit,
    review_potential,
)
from engine.results import DivergentStart
from engine.slices.default_window import default_window
from engine.slices.limiting_curves import trace_zero_velocity_curve
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import evaluate_indicators
from tests.contracts.scaling import Scaling

EXACT = (Scaling(8.0, 4.0**-3), Scaling(1.0, 1.0, 16.0), Scaling(2.0**-6, 1.0), Scaling(1.0, 4.0**8))
INEXACT = (Scaling(3.0, 0.7), Scaling(1.0, 1.0, 8.0))
# Factors near the smallest and largest that are supported. They are not powers of 2.
FAR = (Scaling(1e-6, 1e6), Scaling(7e4, 5e5), Scaling(1.0, 1.0, 8.0))


def test_a_coefficient_without_effect_is_refused() -> None:
    assert "a coefficient below 1e-18" in str(
        review_potential(Potential("", ((2, 0, 0.5), (0, 2, 0.5), (3, 0, 1.0), (2, 1, 1e-20)))).refusal
    )


# A potential of degree 4, with channels of different kinds, and not in units of its well.
SKEW = Potential("skew", ((2, 0, 0.9), (0, 2, 0.41), (3, 0, 0.23), (1, 2, -0.52), (0, 4, -0.07)))
ENERGY, UNIT_OF_TIME = 1.1 * SKEW.escape_energy, SKEW.units.time


def name_of(scaling: Scaling) -> str:
    return f"L={scaling.length:.3g}, E={scaling.energy:.3g}, m={scaling.mass:.3g}"


exactly_scaled = pytest.mark.parametrize(
    "scaling", [*EXACT[:2], *(pytest.param(each, marks=pytest.mark.exhaustive) for each in EXACT[2:])], ids=name_of
)


def system(scaling: Scaling | None = None) -> tuple[Potential, float]:
    """Return the potential and an energy above its escape energy."""
    return (SKEW, ENERGY) if scaling is None else (scaling.potential(SKEW), scaling.energy * ENERGY)


@cache
def escape_map(plane: Plane, scaling: Scaling | None = None, t_max: float = 2e4, side: int = 15) -> EscapeMap:
    potential, energy = system(scaling)
    energies = (0.9 * energy, 1.1 * energy) if plane.energy_axis is not None else energy
    factor = 1.0 if scaling is None else scaling.time
    return compute_map(MapSpec(potential, plane, energies, (side, side), t_max=factor * UNIT_OF_TIME * t_max))


def equal_maps(scaled: EscapeMap, usual: EscapeMap, scaling: Scaling) -> None:
    for field in ("fate", "crossings", "evidence", "outside", "energy_error"):
        np.testing.assert_array_equal(getattr(scaled, field), getattr(usual, field), field)
    np.testing.assert_array_equal(scaled.escape_time, scaling.time * usual.escape_time)
    assert scaled.spec.find_window() == scaling.window(usual.spec.find_window(), usual.spec.plane)
    assert scaled.horizon == scaling.time * usual.horizon


@exactly_scaled
@pytest.mark.parametrize("plane", [Plane.X_PX, Plane.X_H, Plane.TANGENTIAL])
def test_maps_windows_and_evidence_are_the_same_in_other_units(plane: Plane, scaling: Scaling) -> None:
    usual = escape_map(plane)
    equal_maps(escape_map(plane, scaling), usual, scaling)
    assert np.unique(usual.fate[usual.interior]).size > 1


@exactly_scaled
def test_follow_up_analyses_are_the_same_in_other_units(scaling: Scaling) -> None:
    usual, scaled = escape_map(Plane.X_PX), escape_map(Plane.X_PX, scaling)
    trust = compute_trust(usual)
    np.testing.assert_array_equal(compute_trust(scaled).trust, trust.trust)
    assert np.any(trust.trust == Trust.DOUBTFUL)
    regularity, scaled_regularity = compute_regularity(usual), compute_regularity(scaled)
    np.testing.assert_array_equal(scaled_regularity.character, regularity.character)


def rescaled(orbit: LyapunovOrbit, scaling: Scaling) -> tuple[Any, ...]:
    return orbit.period * scaling.time, orbit.energy * scaling.energy, orbit.x * scaling.length, orbit.y * scaling.length


@exactly_scaled
def test_lyapunov_orbits_are_the_same_in_other_units(scaling: Scaling) -> None:
    usual, scaled = find_lyapunov_orbits(*system()), find_lyapunov_orbits(*system(scaling))
    assert len(scaled) == len(usual) > 0
    for orbit, other in zip(scaled, usual, strict=True):
        for found, expected in zip(rescaled(orbit, Scaling(1.0, 1.0)), rescaled(other, scaling), strict=True):
            np.testing.assert_array_equal(found, expected)


@exactly_scaled
def test_stable_manifolds_are_the_same_in_other_units(scaling: Scaling) -> None:
    usual, scaled = find_stable_manifolds(*system(), images=2), find_stable_manifolds(*system(scaling), images=2)
    assert len(scaled.arcs) == len(usual.arcs) > 0
    assert scaled.truncated == usual.truncated
    for arc, other in zip(scaled.arcs, usual.arcs, strict=True):
        assert (arc.channel, arc.image) == (other.channel, other.image)
        np.testing.assert_array_equal(arc.x, scaling.length * other.x)
        np.testing.assert_array_equal(arc.ordinate, scaling.momentum * other.ordinate)


@exactly_scaled
def test_uncertainty_exponents_are_the_same_in_other_units(scaling: Scaling) -> None:
    potential, energy = CASES["II"], 0.25
    usual, scaled = (
        compute_uncertainty_exponent(
            MapSpec(s.potential(potential), Plane.X_PX, s.energy * energy, t_max=1e3 * s.time), work=1e6, rng=0
        )
        for s in (Scaling(1.0, 1.0), scaling)
    )
    np.testing.assert_array_equal(scaled.separations, scaling.length * usual.separations)
    np.testing.assert_array_equal(scaled.uncertain, usual.uncertain)
    assert scaled.exponent == usual.exponent > 0.0
    share, scaled_share = (fit.amplitude * fit.separations**fit.exponent for fit in (usual, scaled))
    np.testing.assert_allclose(scaled_share, share, rtol=1e-12)


def sea_start() -> np.ndarray:
    """Return the start of an orbit that escapes late, of shape (4,)."""
    usual = escape_map(Plane.X_PX)
    latest = np.unravel_index(np.nanargmax(usual.escape_time), usual.fate.shape)
    state: np.ndarray = usual.spec.start_states(usual.x[latest[1] :][:1], usual.ordinate[latest[0] :][:1])[0]
    return state


@exactly_scaled
def test_single_orbits_are_the_same_in_other_units(scaling: Scaling) -> None:
    potential, start, t_max = system()[0], sea_start(), 300.0 * UNIT_OF_TIME
    orbit = integrate_orbit(potential, start, t_max)
    scaled = integrate_orbit(scaling.potential(potential), scaling.states(start), scaling.time * t_max)
    factors = {"t": scaling.time, "x": scaling.length, "py": scaling.momentum, "sali": 1.0, "r2": scaling.length**2}
    factors |= {"lyapunov_exponent": 1.0 / scaling.time, "fate": 1.0, "crossings": 1.0, "energy": scaling.energy}
    for field, factor in factors.items():
        np.testing.assert_array_equal(getattr(scaled, field), factor * getattr(orbit, field), field)
    assert [verdict.conclusion for verdict in verdicts(scaled)] == [verdict.conclusion for verdict in verdicts(orbit)]
    crossings = orbit.find_section_crossings()
    scaled_crossings = scaled.find_section_crossings()
    np.testing.assert_array_equal(scaled_crossings, crossings * [scaling.length, scaling.momentum])


def verdicts(orbit: Orbit) -> tuple[Any, ...]:
    return evaluate_indicators(replace(orbit, fate=int(Fate.BOUNDED)))


@exactly_scaled
def test_measures_of_single_orbits_are_the_same_in_other_units(scaling: Scaling) -> None:
    usual, start, t_max = system()[0], sea_start(), 100.0 * UNIT_OF_TIME
    for_both = []
    for s in (Scaling(1.0, 1.0), scaling):
        potential, state = s.potential(usual), s.states(start)
        quiet = s.states(0.1 * start * [1.0, 0.0, 1.0, 1.0])
        separation = compute_separation(potential, state, 1.0000001 * state, s.time * t_max)
        digits = compute_birkhoff_digits(potential, quiet, 2000.0 * UNIT_OF_TIME * s.time)
        near = find_divergent_start(potential, Plane.X_PX, float(potential.energy(state)), state[0], state[2], s.time * t_max)
        assert isinstance(near, DivergentStart)
        for_both.append([
            *(separation.t / s.time, separation.distance / s.length),
            *(digits.windows / s.time, digits.digits),
            *(near.x / s.length, near.ordinate / s.momentum, near.distance / s.length, near.fate),
        ])  # fmt: skip
    for scaled, expected in zip(*reversed(for_both), strict=True):
        np.testing.assert_array_equal(scaled, expected)


@pytest.mark.parametrize("scaling", [*INEXACT, *FAR], ids=name_of)
def test_reviews_and_zero_velocity_curves_are_the_same_in_other_units(scaling: Scaling) -> None:
    (usual, energy), (potential, _) = system(), system(scaling)
    review, scaled = review_potential(usual), review_potential(potential)
    assert scaled.refusal is None is review.refusal
    assert scaled.escape_energy == pytest.approx(scaling.energy * review.escape_energy, rel=1e-12)
    assert [point.kind for point in scaled.critical_points] == [point.kind for point in review.critical_points]
    window = default_window(usual, Plane.X_Y, energy)
    curves = trace_zero_velocity_curve(usual, Plane.X_Y, energy, window)
    others = trace_zero_velocity_curve(potential, Plane.X_Y, scaling.energy * energy, scaling.window(window, Plane.X_Y))
    for other, curve in zip(others, curves, strict=True):
        np.testing.assert_allclose(other, scaling.length * curve, atol=1e-9 * scaling.length)


@pytest.mark.parametrize("scaling", FAR, ids=name_of)
def test_maps_and_verdicts_are_the_same_in_units_that_round(scaling: Scaling) -> None:
    potential, energy, t_max = CASES["III"], 0.3, 2e3
    scaled = scaling.potential(potential)
    usual = compute_map(MapSpec(potential, Plane.X_PX, energy, (24, 24), t_max=t_max))
    found = compute_map(MapSpec(scaled, Plane.X_PX, scaling.energy * energy, (24, 24), t_max=scaling.time * t_max))
    doubtful = compute_trust(usual).trust == Trust.DOUBTFUL
    np.testing.assert_array_equal(found.fate[~doubtful], usual.fate[~doubtful])
    states = np.array([[0.1, 0.0, 0.05, 0.4], [0.0, 0.0, 0.02, 0.4]])
    for state in states:
        orbit = integrate_orbit(potential, state, t_max)
        other = integrate_orbit(scaled, scaling.states(state), scaling.time * t_max)
        assert judge_orbit(other).character is judge_orbit(orbit).character
        assert other.digits_of_halves == pytest.approx(orbit.digits_of_halves, abs=0.5)
