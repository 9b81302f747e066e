"""Maps in double-double arithmetic: against heyoka with quadruple precision, against maps in doubles, and energy conservation."""

from __future__ import annotations

import functools
import math
from fractions import Fraction

import heyoka as hy
import numpy as np
import pytest

from engine import (
    CASES,
    DeepMap,
    Fate,
    MapSpec,
    ParameterAxis,
    Plane,
    System,
    Trust,
    compute_deep_map,
    compute_map,
    compute_trust,
)
from engine.maps.deep_starts import simplest_number
from engine.slices.axes import Coordinate
from engine.slices.slice import Slice

POTENTIAL, ENERGY, SIDE, T_MAX = CASES["II"], Fraction(1, 4), 16, 300.0
# All orbits that leave the well of Case II reach this radius, each on its own side of the plane.
FAR = 2.0
# As large as the rounding errors of these orbits, whose energy errors are some 1e-31; 1/60 000 of a pixel at a width of 1e-24.
LAST_BITS = Fraction(1, 10**30)
Quad = getattr(hy, "real128", None)
Place = tuple[Fraction, Fraction]


def deep_map(centre: Place, width: float, resolution: tuple[int, int] = (SIDE, SIDE)) -> DeepMap:
    return compute_deep_map(MapSpec(POTENTIAL, Plane.X_PX, float(ENERGY), resolution, t_max=T_MAX), centre, width)


@functools.cache
def boundary_point(seed: int) -> Place:
    """A point between starts of different fates that are about 1e-28 apart, found by dividing an interval again and again."""
    rng, width, columns = np.random.default_rng(seed), 0.5, 16
    centre = Fraction(0), Fraction(1, 10)
    while width > 1e-27:
        fate = deep_map(centre, width, (columns, 1)).fate[0]
        unlike = np.flatnonzero(fate[1:] != fate[:-1])
        if not unlike.size:
            # The boundary lies between an end of the interval and the outermost pixel.
            return boundary_point(seed + 100)
        between = int(rng.choice(unlike))
        centre = centre[0] + Fraction(repr(width)) * Fraction(2 * between + 2 - columns, 2 * columns), centre[1]
        width /= columns
    return centre


def quad(value: Fraction):
    total = Quad(0)
    for _ in range(4):
        part = float(value)
        total, value = total + Quad(part), value - Fraction(part)
    return total


@functools.cache
def integrator():
    x, y, px, py = hy.make_vars("x", "y", "px", "py")
    equations = [(x, px), (y, py), (px, -x + x * x - y * y), (py, -y - 2.0 * x * y)]
    far = hy.t_event(x * x + y * y - FAR**2, direction=hy.event_direction.positive, fp_type=Quad)
    return hy.taylor_adaptive(equations, [Quad(0)] * 4, t_events=[far], fp_type=Quad)


def quad_fate(x: Fraction, px: Fraction) -> int:
    """The channel through which an orbit leaves in arithmetic with 113 bits."""
    squared = 2 * ENERGY - x * x + 2 * x**3 / 3 - px * px
    py = Fraction(math.isqrt((squared.numerator << 512) // squared.denominator), 1 << 256)
    peer = integrator()
    peer.reset_cooldowns()
    peer.time = Quad(0)
    peer.state[:] = np.array([quad(each) for each in (x, Fraction(0), px, py)])
    peer.propagate_until(Quad(T_MAX))
    end = float(peer.state[0]), float(peer.state[1])
    if math.hypot(*end) < 0.99 * FAR:
        return 0
    exits = np.arctan2(*POTENTIAL.saddles.T[::-1])
    return 1 + int(np.argmin(np.abs(np.angle(np.exp(1j * (exits - math.atan2(end[1], end[0])))))))


def count_wrong(seed: int, width: float, rows: int) -> tuple[int, int]:
    """Of the first rows of a map at a boundary: pixels wrong, and pixels whose fate changes with the last bits of the start."""
    x, px = boundary_point(seed)
    found = deep_map((x, px), width)
    assert len(np.unique(found.fate)) > 1
    moved = [deep_map((x + shift, px - shift), width).fate for shift in (LAST_BITS, -LAST_BITS, 2 * LAST_BITS)]
    changes = np.any([each != found.fate for each in moved], axis=0)[:rows]
    offsets = [Fraction(repr(width)) * Fraction(2 * k + 1 - SIDE, 2 * SIDE) for k in range(SIDE)]
    wrong = [[quad_fate(x + dx, px + dp) for dx in offsets] for dp in offsets[:rows]] != found.fate[:rows]
    return int(np.sum(wrong & ~changes)), int(np.sum(changes))


needs_quadruple = pytest.mark.skipif(Quad is None, reason="this build of heyoka has no quadruple precision")


@needs_quadruple
def test_fates_at_a_width_of_1e_20_are_those_of_quadruple_precision() -> None:
    wrong, changing = count_wrong(1, 1e-20, rows=2)
    assert wrong == 0
    assert changing <= 1


@needs_quadruple
@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize(("width", "most_changing"), [(1e-6, 0), (1e-14, 2), (1e-20, 8), (1e-24, 26)])
def test_only_fates_that_change_with_the_last_bits_are_wrong(seed: int, width: float, most_changing: int) -> None:
    wrong, changing = count_wrong(seed, width, rows=SIDE)
    assert wrong == 0
    assert changing <= most_changing


@pytest.mark.parametrize("case", CASES)
def test_energy_is_conserved_to_28_digits(case: str) -> None:
    spec = MapSpec(CASES[case], Plane.X_PX, {"I": 0.15, "II": 0.18, "III": 0.3}[case], (8, 4), t_max=1000.0)
    deep = compute_deep_map(spec, ("0.1", "0.05"), 0.5)
    assert np.nanmax(np.where(deep.interior, deep.escape_time, np.nan)) > 50.0
    assert np.nanmax(deep.energy_error) < 1e-28


def test_pixels_that_double_precision_supports_have_the_same_outcome() -> None:
    whole = compute_map(MapSpec(POTENTIAL, Plane.X_PX, 0.25, (32, 32), (0.0999995, 0.1000005, -5e-7, 5e-7), t_max=T_MAX))
    deep = deep_map((Fraction(1, 10), Fraction(0)), 1e-6, (32, 32))
    trusted = compute_trust(whole).trust != Trust.DOUBTFUL
    assert trusted.mean() > 0.9
    assert np.array_equal(deep.fate[trusted], whole.fate[trusted])
    assert np.array_equal(deep.crossings[trusted], whole.crossings[trusted])
    np.testing.assert_allclose(deep.escape_time[trusted], whole.escape_time[trusted], atol=1e-2)


def test_a_map_in_other_units_is_the_same() -> None:
    # V(x/4)·16: lengths and momenta are four times as large.
    scaled = System("typed", "0.5 (x^2 + y^2) + x y^2 / 4 - x^3 / 12").potential
    spec = MapSpec(scaled, Plane.X_PX, 4.0, (6, 6), t_max=T_MAX)
    deep, unscaled = compute_deep_map(spec, ("0.4", "0.8"), 4e-3), deep_map((Fraction(1, 10), Fraction(1, 5)), 1e-3, (6, 6))
    assert np.array_equal(deep.fate, unscaled.fate)
    np.testing.assert_allclose(deep.escape_time, unscaled.escape_time, rtol=1e-12)


def test_forbidden_and_outside_starts_have_no_orbit() -> None:
    fate = deep_map((Fraction(0), Fraction(0)), 4.0, (12, 12)).fate
    assert {Fate.FORBIDDEN, Fate.OUTSIDE} <= set(fate.ravel().tolist())


def test_a_deep_map_says_its_arithmetic_and_its_centre() -> None:
    deep = compute_deep_map(
        MapSpec(POTENTIAL, Plane.X_PX, 0.25, (4, 4), t_max=50.0), ("0.10000000000000000000000001", "1/3"), 1e-26
    )
    attributes = deep.to_xarray().attrs
    assert attributes["arithmetic"] == "double-double"
    assert Fraction(attributes["centre"][0]) == Fraction("0.10000000000000000000000001")
    assert "double-double" in repr(deep)
    assert deep.plot() is not None


def test_doubles_stand_for_simple_numbers() -> None:
    numbers = {
        -1.0 / 3.0: Fraction(-1, 3),
        0.19: Fraction(19, 100),
        0.123456789: Fraction("0.123456789"),
        1e-9: Fraction(1, 10**9),
    }
    assert all(simplest_number(value) == exact for value, exact in numbers.items())


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"potential": System("typed", "0.5 (x^2 + y^2) - x y^2 exp(-y^2)").potential}, "must be a polynomial"),
        ({"plane": Slice(Coordinate.X, Coordinate.THETA)}, "must have no axis but x, y, px, py"),
        ({"plane": Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("II")))}, "must have no axis but x, y, px, py"),
        ({"window": (0.0, 0.1, 0.0, 0.1)}, "centre and width are the window"),
        ({"centre": (0.1, 0.2)}, "decimal text or Fractions"),
        ({"centre": ("0.1", "abc")}, "decimal text or Fractions"),
        ({"centre": ("0.1", "1e999999999")}, "decimal text or Fractions"),
        ({"centre": ("inf", "1/0")}, "decimal text or Fractions"),
        ({"width": -1.0}, "must be a finite number above 0"),
        ({"width": 1e-29}, "must be 1e-29 or more"),
    ],
)
def test_what_a_deep_map_cannot_show_is_refused(changed: dict, message: str) -> None:
    given = {"potential": POTENTIAL, "plane": Plane.X_PX, "centre": ("0.1", "0.2"), "width": 1e-20, "window": None, **changed}
    spec = MapSpec(given["potential"], given["plane"], 0.25, (4, 4), given["window"], t_max=50.0)
    with pytest.raises(ValueError, match=message):
        compute_deep_map(spec, given["centre"], given["width"])
