"""The small picture of an orbit shows its path in its well, as large as the window of the well."""

from __future__ import annotations

import re

import numpy as np
import pytest

from app.views.orbits.path_picture import path_picture
from engine import CASES, Fate, MapSpec, Plane, integrate_orbit
from plots.pictures.orbit_curves import compute_orbit_curves


def test_the_end_of_a_long_path_that_leaves_is_drawn() -> None:
    # A change of this start by 1e-8 changes the escape time by 0.004, so rounding errors do not matter.
    x, px = 0.04, 0.38
    py = np.sqrt(2.0 * (0.13 - CASES["I"].value(x, 0.0)) - px**2)
    orbit = integrate_orbit(CASES["I"], (x, 0.0, px, float(py)), t_max=400.0)
    assert orbit.fate > Fate.BOUNDED
    assert orbit.escape_time > 150.0
    curves = compute_orbit_curves(CASES["I"], orbit)
    picture = path_picture(curves, "#123456")
    last = re.findall(r"<polyline points='([^']*)' fill='none' stroke='#123456'", picture)[0].split()[-1]
    side = float(re.findall(r"width='(\d+)'", picture)[0])
    x, y = (curve[-1] for curve in curves.path)
    expected = (x - curves.window.x_low, curves.window.ordinate_high - y)
    assert [float(place) * curves.window.width / side for place in last.split(",")] == pytest.approx(expected, abs=0.1)


def test_the_path_begins_at_the_start_inside_the_limiting_curve() -> None:
    orbit = integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.5), t_max=20.0)
    curves = compute_orbit_curves(CASES["II"], orbit)
    picture = path_picture(curves, "#123456")
    *walls, (points, colour) = re.findall(r"<polyline points='([^']*)' fill='none' stroke='([^']*)'", picture)
    assert colour == "#123456"
    assert {colour for _, colour in walls} == {"currentColor"}
    [side] = {float(number) for number in re.findall(r"(?:width|height)='(\d+)'", picture)}
    window = curves.window

    def positions(text: str) -> np.ndarray:
        left, top = np.array([pair.split(",") for pair in text.split()], float).T * window.width / side
        return np.array([window.x_low + left, window.ordinate_high - top])

    assert positions(points)[:, 0] == pytest.approx([orbit.x[0], orbit.y[0]], abs=window.width / side)
    pieces = MapSpec(CASES["II"], Plane.X_Y, orbit.energy, window=window).trace_zero_velocity_curve()
    assert len(walls) == len(pieces)
    on_wall = np.concatenate([CASES["II"].value(*positions(text)) for text, _ in walls])
    np.testing.assert_allclose(on_wall, orbit.energy, atol=0.03)
    assert CASES["II"].value(*positions(points)).max() < orbit.energy + 0.03
