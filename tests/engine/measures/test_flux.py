"""Flux and volume agree with quadrature, the limit at the saddle and escapes of random starts, in any units."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate

from engine import (
    CASES,
    POTENTIALS,
    Plane,
    Potential,
    classify_orbits,
    compute_flux,
    find_lyapunov_orbits,
    parse_formula,
    sample_starts,
)
from engine.exits.interior import find_outside_channels
from engine.slices.default_window import default_window

# Standard errors by which a share may be off: the probability of a false alarm is 6e-7 for each.
LARGEST_DEVIATION = 5.0
HENON_HEILES = POTENTIALS["HH"]
SYSTEMS = [(CASES["I"], 0.19), (CASES["III"], 0.45), (HENON_HEILES, 0.2)]
each_system = pytest.mark.parametrize(("potential", "energy"), SYSTEMS)


@each_system
def test_flux_is_the_integral_over_the_exit_of_all_outward_velocities(potential: Potential, energy: float) -> None:
    # Per length of the exit: ∫ (v·n)₊ δ(H − h) dpx dpy = 2 √(2 (h − V)).
    for orbit, flux in zip(find_lyapunov_orbits(potential, energy), compute_flux(potential, energy).flux, strict=True):
        path = orbit.half_path
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        speed = np.sqrt(2.0 * np.clip(energy - potential.value(*path.T), 0.0, None))
        assert flux == pytest.approx(2.0 * integrate.trapezoid(speed, lengths), rel=1e-3)


def test_the_area_inside_is_that_of_a_disc_where_the_well_is_nearly_round() -> None:
    # With V = ½ r² − r³ f(θ), the area is 2πh + 12 h² ∫ f² dθ + …. For case I, the integral of f² = cos² θ sin⁴ θ is π/8.
    h = 0.01
    found = compute_flux(CASES["I"], h)
    assert found.area == pytest.approx(2.0 * math.pi * h * (1.0 + 0.75 * h), rel=5e-4)
    assert (found.decay_rate, found.mean_passage_time, found.flux.size) == (0.0, math.inf, 0)


@each_system
def test_area_agrees_with_the_share_of_random_points(potential: Potential, energy: float) -> None:
    found, window = compute_flux(potential, energy), default_window(potential, Plane.X_Y, energy)
    random = np.random.default_rng(5)
    x, y = (
        random.uniform(window.x_low, window.x_high, 100_000),
        random.uniform(window.ordinate_low, window.ordinate_high, 100_000),
    )
    inside = (potential.value(x, y) <= energy) & (find_outside_channels(potential, energy, x, y) == 0)
    whole = (window.x_high - window.x_low) * (window.ordinate_high - window.ordinate_low)
    error = math.sqrt(inside.mean() * (1.0 - inside.mean()) / inside.size)
    assert found.area / whole == pytest.approx(inside.mean(), abs=LARGEST_DEVIATION * error)
    assert found.area_error < 1e-3 * found.area


@each_system
def test_starts_on_the_energy_surface_leave_at_the_rate_of_flux_over_volume(potential: Potential, energy: float) -> None:
    count, time = 50_000, 0.5
    fate = classify_orbits(potential, energy, sample_starts(potential, energy, count, rng=2), t_max=time).fate
    found = compute_flux(potential, energy)
    for channel, flux in zip(found.channels, found.flux, strict=True):
        expected = flux * time / found.volume
        assert np.mean(fate == channel) == pytest.approx(expected, abs=LARGEST_DEVIATION * math.sqrt(expected / count))


def test_flux_and_volume_follow_the_units() -> None:
    length, energy = 3.0, 0.7
    scaled = Potential("scaled", tuple((i, j, c * energy / length ** (i + j)) for i, j, c in CASES["II"].terms))
    one, other = compute_flux(CASES["II"], 0.25), compute_flux(scaled, 0.25 * energy)
    np.testing.assert_allclose(other.flux, one.flux * length * math.sqrt(energy), rtol=1e-9)
    assert other.volume == pytest.approx(one.volume * length**2, rel=1e-6)


def test_the_share_of_the_flux_that_comes_back_is_that_of_orbits_below_a_second_barrier() -> None:
    # The motion along x and along y is separable. Along x, barriers of 19/30 and 9/10 follow each other, so the orbits between
    # both come back. The flux is proportional to the phase-space area of the motion along y.
    potential, h = parse_formula("½y² + 3x² − 11/3 x³ + 3/2 x⁴ − x⁵/5"), 1.2
    found = compute_flux(potential, h)
    expected = 1.0 - (h - 9 / 10) / (h - 19 / 30)
    assert found.returning == pytest.approx([expected], abs=0.03)
    assert f"{100.0 * found.returning_share:.3g} % of the flux comes back" in found.describe()


@pytest.mark.parametrize("energy", [0.11, 0.15, 0.19])
def test_all_flux_into_closed_wells_comes_back(energy: float) -> None:
    potential = parse_formula("½r² + 0.5226(x³ − 3xy²) + 0.0727r⁴")
    assert compute_flux(potential, energy).returning.tolist() == [1.0, 1.0, 1.0]


@each_system
def test_no_flux_through_the_exits_of_the_paper_comes_back(potential: Potential, energy: float) -> None:
    found = compute_flux(potential, energy)
    assert not found.returning.any()
    assert "None of the flux comes back" in found.describe()


def test_some_flux_comes_back_from_a_bent_channel() -> None:
    # An independent integration of an orbit that turns beyond exit 4: tests/referee, "turn beyond an exit".
    potential = parse_formula("½(1.2987x² + 0.6412y²) + 0.6056x³y³ − 0.8367x⁵y")
    returning = dict(zip((1, 2, 3, 4), compute_flux(potential, 3.0922300851203053).returning, strict=True))
    assert returning[1] == returning[3] == 0.0
    assert 0.01 < returning[2] == returning[4] < 0.05


def test_orbits_in_a_large_well_beyond_the_exits_do_not_come_back_far_from_the_exits() -> None:
    # Of 42 such orbits, integrated with DOP853, 9 come back. All cross the lines that continue the exits, in the large wells.
    potential = parse_formula("½(0.3124x² + 0.7225y²) − 1.361xy²/(1 + 0.9387y²)")
    found = compute_flux(potential, 0.013322005209246054)
    assert found.returning == pytest.approx([0.2, 0.2], abs=0.05)


def test_the_area_of_a_bent_well_contains_the_parts_behind_its_bend() -> None:
    # A shear turns the well into ½u² − ⅜u³ + y²/128 ≤ h, which has the same area. Rays from the origin end before y = 3.8.
    potential = parse_formula("½(x − y²/16)² − ⅜(x − y²/16)³ + y²/128")
    h = 0.99 * potential.escape_energy

    def width(y: float) -> float:
        bounds = np.sort(np.roots([-0.375, 0.5, 0.0, y**2 / 128.0 - h]).real)
        return float(bounds[1] - bounds[0])

    expected = 2.0 * integrate.quad(width, 0.0, math.sqrt(128.0 * h), epsabs=1e-8)[0]
    found = compute_flux(potential, h)
    assert found.area == pytest.approx(expected, rel=1e-4)
    assert abs(found.area - expected) < 10.0 * found.area_error


@pytest.mark.parametrize("h", [0.3, 100.0, 1e6])
def test_the_area_of_an_ellipse_is_known_at_any_energy(h: float) -> None:
    assert compute_flux(parse_formula("x² + 4y²"), h).area == pytest.approx(0.5 * math.pi * h, rel=2e-4)
