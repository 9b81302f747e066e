"""Reduced curves of orbits keep all visible features."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, integrate_orbit, parse_formula, start_states
from engine.slices.default_window import default_window
from plots.pictures.orbit_curves import (
    TRAIL_DURATION,
    OrbitCurves,
    compute_orbit_curves,
    find_trail,
    restrict_curves,
)


def curves_of(t_max: float) -> OrbitCurves:
    state = start_states(CASES["III"], Plane.X_PX, 0.2, np.zeros(1), np.full(1, 0.1))[0]
    return compute_orbit_curves(CASES["III"], integrate_orbit(CASES["III"], state, t_max))


@pytest.fixture(scope="module")
def short() -> OrbitCurves:
    return curves_of(200.0)


@pytest.fixture(scope="module")
def long() -> OrbitCurves:
    return curves_of(2000.0)


def test_a_long_path_is_a_density_image(long: OrbitCurves) -> None:
    assert long.visits is not None
    rows, columns = long.visits.shape
    window = long.window
    column = ((long.orbit.x - window.x_low) / (window.x_high - window.x_low) * columns).astype(int)
    row = ((long.orbit.y - window.ordinate_low) / (window.ordinate_high - window.ordinate_low) * rows).astype(int)
    assert np.mean(long.visits[row, column] > 0) > 0.99
    assert np.mean(long.visits > 0) < 0.9


def test_the_density_image_has_the_colour_of_the_orbit(long: OrbitCurves) -> None:
    pixels = long.shaded("#102030").view(np.uint8).reshape(*long.visits.shape, 4)  # type: ignore[union-attr]
    assert set(map(tuple, pixels[..., :3].reshape(-1, 3).tolist())) == {(0x10, 0x20, 0x30)}
    np.testing.assert_array_equal(pixels[..., 3], long.visits)


def test_an_interval_of_a_long_orbit_has_every_sample(long: OrbitCurves) -> None:
    part = restrict_curves(long, 1000.0, 1030.0)
    inside = (long.orbit.t >= 1000.0) & (long.orbit.t <= 1030.0)
    times, values = part.histories["r2"].line
    np.testing.assert_array_equal(times, long.orbit.t[inside])
    np.testing.assert_array_equal(values, long.orbit.r2[inside])
    assert part.visits is None
    assert part.path[0].size == times.size


@pytest.mark.parametrize("t", [-1.0, 0.0, 3.3, 150.0, 1e9])
def test_a_trail_ends_at_the_current_position(short: OrbitCurves, t: float) -> None:
    trail, orbit = find_trail(short.orbit, t), short.orbit
    index = int(np.clip(np.searchsorted(orbit.t, t, side="right") - 1, 0, orbit.t.size - 1))
    assert (trail.x[-1], trail.y[-1]) == (orbit.x[index], orbit.y[index])
    assert (trail.x.size - 1) * orbit.t[1] <= TRAIL_DURATION + 1e-9


def test_an_orbit_outside_with_less_energy_than_the_well_is_shown_with_the_whole_well() -> None:
    potential = parse_formula("½(x² + y²) − x⁴ − y⁴")
    state = start_states(potential, Plane.X_H, (-0.5, 0.1), np.ones(1), np.full(1, -0.4))[0]
    curves = compute_orbit_curves(potential, integrate_orbit(potential, state, 10.0))
    assert curves.orbit.energy == pytest.approx(-0.4)
    assert curves.window == default_window(potential, Plane.X_Y, potential.escape_energy)


def test_an_orbit_of_a_well_without_saddles_whose_exits_are_not_known_is_shown_near_the_origin() -> None:
    potential = parse_formula("1 − exp(−x² − y²)")
    orbit = integrate_orbit(potential, (0.1, 0.0, 0.0, 2.8), 20.0)
    assert orbit.exits_unknown
    assert potential.saddles.size == 0
    window = compute_orbit_curves(potential, orbit, with_visits=False).window
    assert orbit.y.max() > window.x_high == 10.0 * potential.units.length
