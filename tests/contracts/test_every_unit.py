"""Every public result is the same one in other units: under x → L x and V → E V, times scale as L/√E.

With L a power of 2 and E a power of 4 all conversions are exact, and so must be the results.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    DivergentStart,
    EscapeMap,
    Fate,
    LyapunovOrbit,
    MapSpec,
    Orbit,
    Plane,
    Potential,
    Trust,
    Window,
    classify_orbits,
    compute_birkhoff_digits,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_separation,
    compute_trust,
    compute_uncertainty_exponent,
    default_window,
    evaluate_indicators,
    find_divergent_start,
    find_lyapunov_orbits,
    find_stable_manifolds,
    integrate_orbit,
    judge_orbit,
    review_potential,
    start_states,
    trace_zero_velocity_curve,
)
from engine.potentials.known_potentials import POTENTIALS
from engine.potentials.well_units import WellUnits
from engine.sweeps.measures import SweepPoint, compute_point


@dataclass(frozen=True)
class Scaling:
    """Factors of lengths and of energies."""

    length: float
    energy: float

    @property
    def time(self) -> float:
        return self.length / self.energy**0.5

    @property
    def momentum(self) -> float:
        return self.energy**0.5

    def potential(self, potential: Potential) -> Potential:
        terms = tuple((i, j, c * self.energy / self.length ** (i + j)) for i, j, c in potential.terms)
        return Potential(potential.name, terms)

    def window(self, window: Window, plane: Plane) -> Window:
        return window.scaled(*plane.axis_units(WellUnits(self.length, self.time)))

    def states(self, states: np.ndarray) -> np.ndarray:
        return states * [self.length, self.length, self.momentum, self.momentum]


EXACT = (Scaling(2.0**-6, 1.0), Scaling(8.0, 4.0**-3), Scaling(1.0, 4.0**8))
INEXACT = (Scaling(3.0, 0.7), Scaling(0.01, 1e-3))
# Of degree 4, with channels of different kinds, and in other units than those of its well.
SKEW = Potential("skew", ((2, 0, 0.9), (0, 2, 0.41), (3, 0, 0.23), (1, 2, -0.52), (0, 4, -0.07)))
SYSTEMS = {"II": (CASES["II"], 0.19), "C5": (POTENTIALS["C5"], 1.2), "skew": (SKEW, 1.1)}


def name_of(scaling: Scaling) -> str:
    return f"L={scaling.length:.3g}, E={scaling.energy:.3g}"


exactly_scaled = pytest.mark.parametrize(
    "scaling", [*EXACT[:2], pytest.param(EXACT[2], marks=pytest.mark.exhaustive)], ids=name_of
)
roughly_scaled = pytest.mark.parametrize("scaling", INEXACT, ids=name_of)
each_system = pytest.mark.parametrize("name", ["II", "skew"])


def system(name: str, scaling: Scaling | None = None) -> tuple[Potential, float]:
    """A potential and an energy above its escape energy."""
    potential, factor = SYSTEMS[name]
    energy = factor if name == "II" else factor * potential.escape_energy
    return (potential, energy) if scaling is None else (scaling.potential(potential), scaling.energy * energy)


def times(name: str) -> float:
    """A time unit of the potential's well."""
    return system(name)[0].units.time


@cache
def escape_map(name: str, plane: Plane, scaling: Scaling | None = None, t_max: float = 2e4, side: int = 15) -> EscapeMap:
    potential, energy = system(name, scaling)
    energies = (0.9 * energy, 1.1 * energy) if plane.energy_axis is not None else energy
    factor = 1.0 if scaling is None else scaling.time
    return compute_map(MapSpec(potential, plane, energies, (side, side), t_max=factor * times(name) * t_max))


def equal_maps(scaled: EscapeMap, usual: EscapeMap, scaling: Scaling) -> None:
    for field in ("fate", "crossings", "certificate", "outside", "energy_error"):
        np.testing.assert_array_equal(getattr(scaled, field), getattr(usual, field), field)
    np.testing.assert_array_equal(scaled.escape_time, scaling.time * usual.escape_time)
    assert scaled.spec.find_window() == scaling.window(usual.spec.find_window(), usual.spec.plane)
    assert scaled.horizon == scaling.time * usual.horizon


@each_system
@exactly_scaled
@pytest.mark.parametrize("plane", Plane)
def test_maps_windows_and_certificates(name: str, plane: Plane, scaling: Scaling) -> None:
    usual = escape_map(name, plane)
    equal_maps(escape_map(name, plane, scaling), usual, scaling)
    assert np.unique(usual.fate[usual.interior]).size > 1


@each_system
@exactly_scaled
def test_follow_up_analyses(name: str, scaling: Scaling) -> None:
    usual, scaled = escape_map(name, Plane.X_PX), escape_map(name, Plane.X_PX, scaling)
    trust = compute_trust(usual)
    np.testing.assert_array_equal(compute_trust(scaled).trust, trust.trust)
    assert np.any(trust.trust == Trust.DOUBTFUL)
    regularity, scaled_regularity = compute_regularity(usual), compute_regularity(scaled)
    np.testing.assert_array_equal(scaled_regularity.character, regularity.character)


@each_system
@exactly_scaled
def test_resumed_maps_and_origins(name: str, scaling: Scaling) -> None:
    for_both = []
    for factor, whole in ((1.0, escape_map(name, Plane.X_PX)), (scaling.time, escape_map(name, Plane.X_PX, scaling))):
        shorter = compute_map(replace(whole.spec, t_max=30.0 * times(name) * factor))
        resumed = compute_map(replace(whole.spec, t_max=90.0 * times(name) * factor), resume=shorter)
        origins = compute_origin_fates(shorter.spec)
        for_both.append((resumed.fate, resumed.escape_time / factor, origins.origin))
    for scaled, usual in zip(*reversed(for_both), strict=True):
        np.testing.assert_array_equal(scaled, usual)


@each_system
@exactly_scaled
def test_curve_points_with_uncertainty_exponents(name: str, scaling: Scaling) -> None:
    usual, scaled = escape_map(name, Plane.X_PX), escape_map(name, Plane.X_PX, scaling)
    outcomes, measures = usual.spec.outcomes, ("shares", "islands", "escape_times")
    point, scaled_point = (
        compute_point(SweepPoint(m.spec, "h", 0.2, measures, tuple(range(len(outcomes) + 1)), outcomes), frame=m)
        for m in (usual, scaled)
    )
    np.testing.assert_array_equal(scaled_point["share"], point["share"])
    assert scaled_point["largest_island"] == scaling.length * scaling.momentum * point["largest_island"]
    assert scaled_point["median_escape_time"] == scaling.time * point["median_escape_time"]
    found, scaled_found = (compute_uncertainty_exponent(m.spec, pairs=40, separations=7, work=1e5) for m in (usual, scaled))
    np.testing.assert_array_equal(scaled_found.uncertain, found.uncertain)
    np.testing.assert_array_equal(scaled_found.separations, scaling.length * found.separations)
    np.testing.assert_array_equal(scaled_found.exponent, found.exponent)
    assert scaled_found.horizon == scaling.time * found.horizon


def rescaled(orbit: LyapunovOrbit, scaling: Scaling) -> tuple[Any, ...]:
    return orbit.period * scaling.time, orbit.energy * scaling.energy, orbit.x * scaling.length, orbit.y * scaling.length


@each_system
@exactly_scaled
def test_lyapunov_orbits(name: str, scaling: Scaling) -> None:
    usual, scaled = find_lyapunov_orbits(*system(name)), find_lyapunov_orbits(*system(name, scaling))
    assert len(scaled) == len(usual) > 0
    for orbit, other in zip(scaled, usual, strict=True):
        for found, expected in zip(rescaled(orbit, Scaling(1.0, 1.0)), rescaled(other, scaling), strict=True):
            np.testing.assert_array_equal(found, expected)


@each_system
@exactly_scaled
def test_stable_manifolds(name: str, scaling: Scaling) -> None:
    usual, scaled = find_stable_manifolds(*system(name), images=2), find_stable_manifolds(*system(name, scaling), images=2)
    assert len(scaled.arcs) == len(usual.arcs) > 0
    assert scaled.truncated == usual.truncated
    for arc, other in zip(scaled.arcs, usual.arcs, strict=True):
        assert (arc.channel, arc.image) == (other.channel, other.image)
        np.testing.assert_array_equal(arc.x, scaling.length * other.x)
        np.testing.assert_array_equal(arc.px, scaling.momentum * other.px)


def sea_start(name: str) -> np.ndarray:
    """(4,) the start of an orbit that escapes late."""
    usual = escape_map(name, Plane.X_PX)
    latest = np.unravel_index(np.nanargmax(usual.escape_time), usual.fate.shape)
    state: np.ndarray = usual.spec.start_states(usual.x[latest[1] :][:1], usual.ordinate[latest[0] :][:1])[0]
    return state


@each_system
@exactly_scaled
def test_single_orbits(name: str, scaling: Scaling) -> None:
    potential, start, t_max = system(name)[0], sea_start(name), 300.0 * times(name)
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


@each_system
@exactly_scaled
def test_measures_of_single_orbits(name: str, scaling: Scaling) -> None:
    usual, start, t_max = system(name)[0], sea_start(name), 100.0 * times(name)
    for_both = []
    for s in (Scaling(1.0, 1.0), scaling):
        potential, state = s.potential(usual), s.states(start)
        quiet = s.states(0.1 * start * [1.0, 0.0, 1.0, 1.0])
        separation = compute_separation(potential, state, 1.0000001 * state, s.time * t_max)
        digits = compute_birkhoff_digits(potential, quiet, 2000.0 * times(name) * s.time)
        near = find_divergent_start(potential, Plane.X_PX, float(potential.energy(state)), state[0], state[2], s.time * t_max)
        assert isinstance(near, DivergentStart)
        for_both.append([
            *(separation.t / s.time, separation.distance / s.length),
            *(digits.windows / s.time, digits.digits),
            *(near.x / s.length, near.ordinate / s.momentum, near.distance / s.length, near.fate),
        ])  # fmt: skip
    for scaled, expected in zip(*reversed(for_both), strict=True):
        np.testing.assert_array_equal(scaled, expected)


@each_system
@pytest.mark.parametrize("scaling", [*EXACT, *INEXACT], ids=name_of)
def test_reviews_and_zero_velocity_curves(name: str, scaling: Scaling) -> None:
    (usual, energy), (potential, _) = system(name), system(name, scaling)
    review, scaled = review_potential(usual), review_potential(potential)
    assert scaled.refusal is None is review.refusal
    assert scaled.escape_energy == pytest.approx(scaling.energy * review.escape_energy, rel=1e-12)
    assert [point.kind for point in scaled.critical_points] == [point.kind for point in review.critical_points]
    window = default_window(usual, Plane.X_Y, energy)
    curves = trace_zero_velocity_curve(usual, Plane.X_Y, energy, window)
    others = trace_zero_velocity_curve(potential, Plane.X_Y, scaling.energy * energy, scaling.window(window, Plane.X_Y))
    for other, curve in zip(others, curves, strict=True):
        np.testing.assert_allclose(other, scaling.length * curve, atol=1e-9 * scaling.length)


@each_system
@roughly_scaled
def test_robust_outcomes_in_units_that_round(name: str, scaling: Scaling) -> None:
    potential, energy = system(name)
    scaled, scaled_energy = system(name, scaling)
    usual = escape_map(name, Plane.X_PX)
    robust = (compute_trust(usual).trust == Trust.CONFIRMED) & (usual.escape_time < 100.0 * times(name))
    rows, columns = np.nonzero(robust)
    starts = start_states(potential, Plane.X_PX, energy, usual.x[columns], usual.ordinate[rows])
    found = classify_orbits(scaled, scaled_energy, scaling.states(starts), scaling.time * 1000.0 * times(name))
    np.testing.assert_array_equal(found.fate, usual.fate[robust])
    np.testing.assert_array_equal(found.crossings, usual.crossings[robust])
    np.testing.assert_allclose(found.escape_time, scaling.time * usual.escape_time[robust], rtol=1e-6)
    for orbit, other in zip(find_lyapunov_orbits(scaled, scaled_energy), find_lyapunov_orbits(potential, energy), strict=True):
        assert orbit.period == pytest.approx(scaling.time * other.period, rel=1e-9)
        np.testing.assert_allclose(orbit.x, scaling.length * other.x, rtol=0.0, atol=1e-9 * scaling.length)


# No powers of 2, from the least to the largest that are supported.
FAR = (Scaling(100.0, 0.3), Scaling(1e-6, 1e6), Scaling(1e6, 1e-6), Scaling(3e-5, 2e-4), Scaling(7e4, 5e5))


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("name", ["I", "III", "C5", "skew"])
@pytest.mark.parametrize("scaling", FAR, ids=name_of)
def test_default_windows_in_units_that_round(name: str, plane: Plane, scaling: Scaling) -> None:
    potential = CASES[name] if name in CASES else SYSTEMS[name][0]
    energy, factor = 1.2 * potential.escape_energy, scaling.energy
    usual = default_window(potential, plane, (0.9 * energy, energy) if plane.energy_axis is not None else energy)
    levels = (0.9 * factor * energy, factor * energy) if plane.energy_axis is not None else factor * energy
    found = default_window(scaling.potential(potential), plane, levels)
    units = plane.axis_units(WellUnits(scaling.length, scaling.time))
    restored = found.scaled(*(1.0 / unit for unit in units))
    np.testing.assert_allclose(astuple(restored), astuple(usual), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ["III", "C5", "skew"])
@pytest.mark.parametrize("scaling", FAR, ids=name_of)
def test_reviews_in_units_that_round(name: str, scaling: Scaling) -> None:
    potential = CASES[name] if name in CASES else SYSTEMS[name][0]
    usual, found = review_potential(potential), review_potential(scaling.potential(potential))
    assert (found.refusal, found.channels) == (None, usual.channels)
    assert found.escape_energy == pytest.approx(scaling.energy * usual.escape_energy, rel=1e-9)


def test_a_coefficient_without_effect_is_refused() -> None:
    assert "a coefficient below 1e-18" in str(
        review_potential(Potential("", ((2, 0, 0.5), (0, 2, 0.5), (3, 0, 1.0), (2, 1, 1e-20)))).refusal
    )


@pytest.mark.parametrize(
    "scaling", [*FAR[:2], *(pytest.param(each, marks=pytest.mark.exhaustive) for each in FAR[2:])], ids=name_of
)
def test_maps_and_verdicts_in_units_that_round(scaling: Scaling) -> None:
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


@pytest.mark.parametrize("epsilon", [100.0, 0.01, 1e6])
def test_doubtful_share_does_not_depend_on_the_units(epsilon: float) -> None:
    # For a cubic V1 the strength ε is a unit of length: V(x, y) = ε⁻² V₁(εx, εy).
    scaling = Scaling(1.0 / epsilon, 1.0 / epsilon**2)
    shares = []
    for potential, h in ((CASES["II"], 0.2), (scaling.potential(CASES["II"]), 0.2 * scaling.energy)):
        shares.append(compute_trust(compute_map(MapSpec(potential, Plane.X_PX, h, (75, 75), t_max=1e4))).doubtful_share)
    assert shares[1] == pytest.approx(shares[0], rel=0.1)


@pytest.mark.parametrize(("omega", "epsilon"), [(3.0, 0.03), (0.1, 100.0)])
def test_manifolds_of_a_fast_and_of_a_slow_well(omega: float, epsilon: float) -> None:
    # V = ½ω²r² + εV₁ is the well with ω = 1 and the same shape, in other units: L = ω²/ε and E = ω²L².
    changed = CASES["II"].with_parameters(omega, omega, epsilon)
    scaling = Scaling(omega**2 / epsilon, omega**6 / epsilon**2)
    usual, scaled = (
        find_stable_manifolds(CASES["II"], 0.2, images=2),
        find_stable_manifolds(changed, 0.2 * scaling.energy, images=2),
    )
    lengths = [
        sum(np.hypot(np.diff(arc.x) / s.length, np.diff(arc.px) / s.momentum).sum() for arc in found.arcs)
        for found, s in ((usual, Scaling(1.0, 1.0)), (scaled, scaling))
    ]
    assert lengths[1] == pytest.approx(lengths[0], rel=0.05)
    assert len(scaled.arcs) == pytest.approx(len(usual.arcs), abs=4)
