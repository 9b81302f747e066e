"""Curves through section points enclose the right area, and escaping orbits lie inside them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from engine import CASES, Plane, start_states
from engine.evidence.invariant_curves import InvariantCurve, find_invariant_curve
from engine.propagation.limited_steps import find_section_points

type Curve = Callable[[np.ndarray], np.ndarray]

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


def ellipse(phase: np.ndarray) -> np.ndarray:
    return np.column_stack([0.3 + 0.2 * np.cos(phase), 0.1 * np.sin(phase)])


def boomerang(phase: np.ndarray) -> np.ndarray:
    """Return a thin, strongly bent closed curve that does not enclose its centroid."""
    angle, radius = 1.9 * np.cos(phase), 0.5 + 0.05 * np.sin(phase)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def rotation_points(curve: Curve, count: int, rotation: float = GOLDEN) -> np.ndarray:
    """Return successive points of a rotation on a curve, of shape (count, 2)."""
    return curve(2.0 * np.pi * rotation * np.arange(count) + 0.7)


@pytest.fixture
def ring() -> InvariantCurve:
    curve = find_invariant_curve(rotation_points(ellipse, 300))
    assert curve is not None
    return curve


@pytest.mark.parametrize("rotation", [GOLDEN, 0.01 * GOLDEN + 0.25])
@pytest.mark.parametrize("curve", [ellipse, boomerang])
def test_area_is_correct_for_various_rotation_numbers_and_shapes(curve: Curve, rotation: float) -> None:
    found = find_invariant_curve(rotation_points(curve, 800, rotation))
    exact = curve(np.linspace(0, 2 * np.pi, 5000))
    area = 0.5 * abs(np.sum(exact[:-1, 0] * exact[1:, 1] - exact[1:, 0] * exact[:-1, 1]))
    assert found is not None
    assert found.area == pytest.approx(area, rel=1e-2)


def test_exact_curve_lies_within_the_margin(ring: InvariantCurve) -> None:
    assert set(ring.find_side(ellipse(np.linspace(0, 6.3, 999)))) == {0}
    assert ring.margins[0] < 1e-3


@pytest.mark.parametrize("curve", [ellipse, boomerang])
@pytest.mark.parametrize("off", [1e-6, 5e-5])
def test_margin_covers_the_wide_gaps_near_a_resonance(curve: Curve, off: float) -> None:
    found = find_invariant_curve(rotation_points(curve, 800, 1.0 / 18.0 + off))
    assert found is None or not found.find_side(curve(np.linspace(0, 6.3, 999))).any()


# Starts on invariant tori of III at h = 0.36 whose first 800 points form bunches, and starts near them that escape later.
BUNCHED = [(0.5829907, 0.6006459), (-0.7862344, -0.2537992)]
ESCAPING = [(0.6768284688161396, -0.4609629106555103), (0.5643984906074785, -0.6048732827625964)]


def section_points(start: tuple[float, float], count: int) -> np.ndarray:
    states = start_states(CASES["III"], Plane.X_PX, 0.36, *np.array([start]).T)
    points = find_section_points(CASES["III"], states, count, 8.0 * count)[0]
    found: np.ndarray = points[np.isfinite(points).all(axis=1)]
    return found


@pytest.mark.parametrize("start", BUNCHED)
def test_later_points_stay_within_the_margin(start: tuple[float, float]) -> None:
    points = section_points(start, 6000)
    found = find_invariant_curve(points[:800])
    assert found is None or not found.find_side(points).any()


@pytest.mark.parametrize(("start", "escaping"), list(zip(BUNCHED, ESCAPING, strict=True)))
def test_escaping_orbit_is_not_outside_the_curve(start: tuple[float, float], escaping: tuple[float, float]) -> None:
    """The exits lie inside these curves, so no orbit that starts outside the curves can escape."""
    found = find_invariant_curve(section_points(start, 800))
    assert found is None or found.find_side(section_points(escaping, 200)).max() <= 0


def test_inside_and_outside_are_distinguished(ring: InvariantCurve) -> None:
    np.testing.assert_array_equal(ring.find_side(np.array([[0.3, 0.0], [0.3, 0.2], [0.0, 0.0], [0.49, 0.0]])), [-1, 1, 1, -1])


@pytest.mark.parametrize("islands", [2, 7])
def test_chain_of_islands_gives_one_loop_per_island(islands: int) -> None:
    centre = 2.0 * np.pi * np.arange(700) / islands
    points = 0.02 * rotation_points(ellipse, 700, GOLDEN) + 0.4 * np.column_stack([np.cos(centre), np.sin(centre)])
    curve = find_invariant_curve(points)
    assert curve is not None
    assert len(curve.loops) == islands
    centres = 0.4 * np.column_stack([np.cos(centre[:islands]), np.sin(centre[:islands])]) + [0.006, 0.0]
    np.testing.assert_array_equal(curve.find_side(centres), -1)
    assert curve.find_side(np.zeros((1, 2)))[0] == 1


def test_scattered_points_give_no_curve() -> None:
    assert find_invariant_curve(np.random.default_rng(1).uniform(-1, 1, (400, 2))) is None


def test_periodic_orbit_gives_no_curve() -> None:
    assert find_invariant_curve(rotation_points(ellipse, 400, 0.2)) is None
