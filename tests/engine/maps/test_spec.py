"""Requests of maps have the right pixel centres and windows, and no starts on lines of symmetry."""

from __future__ import annotations

from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest

from engine import CASES, Coordinate, MapSpec, Plane, Slice
from engine.slices.axes import Energy
from engine.slices.default_window import default_window

I = CASES["I"]  # noqa: E741  # named like the case
WINDOW = (-1.0, 1.0, -1.0, 1.0)


def spec_with(**changed: Any) -> MapSpec:
    return MapSpec(**{"potential": I, "plane": Plane.X_Y, "energy": 0.2, "window": WINDOW} | changed)


def test_outer_pixel_centres_are_half_a_pixel_from_the_edges() -> None:
    x, ordinate = spec_with(resolution=(4, 2)).pixel_centres()
    np.testing.assert_allclose(x, [-0.75, -0.25, 0.25, 0.75], rtol=1e-15)
    np.testing.assert_allclose(ordinate, [-0.5, 0.5], rtol=1e-15)


def starts_on_a_symmetry_line(spec: MapSpec) -> int:
    """Return the number of pixels with x = px = 0 or y = py = 0."""
    x, ordinate = np.meshgrid(*spec.pixel_centres())
    states = spec.start_states(x.ravel(), ordinate.ravel())
    return int(sum((states[:, pair] == 0.0).all(axis=1).sum() for pair in ([0, 2], [1, 3])))


# Slices over x and y with a fixed momentum of 0 or a fixed angle, in both orders of the axes.
@pytest.mark.parametrize(
    ("plane", "energy"),
    [
        (Plane.X_Y, 0.6),
        (Plane.X_H, (0.25, 1.0)),
        (Slice(Coordinate.X, Coordinate.Y, Coordinate.PX), 0.6),
        (Slice(Coordinate.Y, Coordinate.X), 0.6),
        (Slice(Coordinate.X, Coordinate.Y, Coordinate.SPEED, 1, ((Coordinate.THETA, 0.0),)), 0.6),
    ],
)
def test_an_odd_number_of_pixels_has_none_on_a_line_of_symmetry(plane: Slice, energy: Energy) -> None:
    count = 45
    spec = MapSpec(CASES["III"], plane, energy, (count, count))
    whole = default_window(CASES["III"], plane, energy)
    assert starts_on_a_symmetry_line(replace(spec, window=whole)) > count // 3
    assert starts_on_a_symmetry_line(spec) == 0
    # The window is shifted by half a pixel along one axis.
    shifts = [astuple(spec.find_window())[k] - astuple(whole)[k] for k in (0, 2)]
    sizes = [(whole.x_high - whole.x_low) / count, (whole.ordinate_high - whole.ordinate_low) / count]
    assert sorted(shift / size for shift, size in zip(shifts, sizes, strict=True)) == pytest.approx([0.0, 0.5])


@pytest.mark.parametrize(
    ("case", "plane", "count"),
    [
        ("III", Plane.X_Y, 224),
        ("III", Plane.X_PX, 225),
        ("III", Plane.TANGENTIAL, 225),
        ("II", Plane.X_Y, 225),
        ("III", Plane.X_Y, 1),
    ],
)
def test_other_maps_have_the_default_window(case: str, plane: Slice, count: int) -> None:
    """The number of pixels is even or 1, or no orbit stays on a line of symmetry of the slice."""
    spec = MapSpec(CASES[case], plane, 0.6, (count, count))
    assert spec.find_window() == default_window(CASES[case], plane, 0.6)
