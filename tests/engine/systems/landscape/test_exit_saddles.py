"""The saddles that lead out of the well at the origin are exits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.systems.landscape.exit_saddles import find_exit_lines, find_maxima_beside
from engine.systems.potential import Potential
from tests.peers.random_systems import random_well
from tests.peers.symmetric_wells import VALLEYS, exchanged, random_symmetric_well

# A ring-shaped valley around a hill, lowest at the origin. The highest point of the valley is a saddle, from which both sides
# descend to the origin.
RING = parse_formula("((x − 1.1)² + y² − 1)² + 0.924x")
# Wells at x = 0, 2 and 4.
ROW = parse_formula("(x(x − 2)(x − 4))²/10 + y²")

# One saddle is at (-0.007, 1897), in a valley whose curvature across is 10^11 times its curvature along.
NARROW_VALLEY = "x^2/2 + y^2/2 - x^3/3 + 0.047*x*y^3 - 0.012*x^6 - 0.183*x^3*y^4 + 0.082*x^4*y - 0.084*x^2*y^2 + 0.184*x*y^2"

INVARIANT_AXIS = "½ log(1.2041x² + 1.2139y² + 1) + 0.8447x²y² sin(0.6865 + x) + 0.3132y³ cos(0.8166x + 1.2107y)"
# A line of steepest ascent from the saddle at (2.603, 0.206) ends at a maximum at (-5.93, 35.27), ten times as far as the others.
REMOTE_MAXIMUM = "½ log(0.9774x² + 1.0093y² + 1) + 1.2008x²y² sin(0.5194 + x) + 1.0261y³ cos(1.4716x + 0.4342y)"


def exits(potential: Potential) -> np.ndarray:
    """Return the saddles that lead out, of shape (n, 2)."""
    points = potential.critical_points
    lines = find_exit_lines(potential.form, points, potential.well.critical_indices)
    return points[np.unique(lines[:, 0].astype(int))]


def test_a_saddle_with_the_origin_below_on_both_sides_is_no_exit() -> None:
    assert exits(RING).size == 0


def test_a_saddle_between_two_other_wells_is_no_exit() -> None:
    np.testing.assert_allclose(exits(ROW), [[2.0 - 2.0 / np.sqrt(3.0), 0.0]], atol=1e-12)


def test_the_hill_lies_beside_the_saddle_behind_it() -> None:
    points = RING.critical_points
    hill, saddle = np.argsort(points[:, 0])[1:]
    beside = find_maxima_beside(RING.form, points, RING.well.critical_indices, np.array([saddle]))
    assert np.flatnonzero(beside).tolist() == [hill]


def test_a_saddle_behind_a_curve_where_the_potential_is_infinite_is_no_exit() -> None:
    # V falls from the saddle at x = 4.65 towards x = 3, and from the other side of x = 3 towards the well.
    behind = parse_formula("½(x² + y²) − 0.08x³ − 1/(x − 3); well (-0.1, 0)")
    assert (behind.critical_points[:, 0] > 4.0).any()
    assert exits(behind).size == 0
    # V falls from the saddle at x = 2.28 towards the well, and towards x = 3.
    before = parse_formula("½(x² + y²) − x³/9 − 0.01x(x − 6)² + 0.3/(x − 3); well (0.36, 0)")
    assert len(exits(before)) == 1


def test_a_saddle_at_the_end_of_a_long_narrow_valley_is_an_exit() -> None:
    potential = parse_formula(NARROW_VALLEY)
    valley = potential.saddles[np.argmax(potential.saddles[:, 1])]
    assert valley[1] == pytest.approx(1896.55543)
    # Along the bottom of the valley, where V_x = 0, V rises from the well to the saddle.
    y = np.linspace(1.0, valley[1], 1000)
    x = np.zeros_like(y)
    for _ in range(50):
        x -= potential.gradient(x, y)[0] / potential.hessian(x, y)[0]
    assert (np.diff(potential.value(x, y)) > 0.0).all()


def test_descents_that_need_an_implicit_method_from_the_start_end() -> None:
    potential = random_well(100, 10)
    farthest = potential.saddles[np.argmax(potential.saddles[:, 0])]
    np.testing.assert_allclose(farthest, [717.83953, -0.02207], atol=1e-5)


def test_descents_whose_first_method_fails_end_without_a_warning() -> None:
    text = "½(x²+y²) − 1.295xy³ − 6x⁶y − 2.133xy² − 1.746x⁴y² + 4x³y³ − 1.67x⁵y⁴ + 0.957x²y + 3x⁵y⁶ − 0.184x² + 9y² + 0.35x⁴y⁵"
    assert len(exits(parse_formula(text))) == 3


def test_a_saddle_close_beside_a_maximum_is_an_exit() -> None:
    # The saddle is at (0, -786.04), and a maximum is at (0.00021, -786.04). The line x = 0 leads to the well.
    potential = parse_formula("½(0.4426x² + 1.2050y²) − 0.001125x³y² + 0.000511y³")
    assert potential.saddles[:, 1].min() == pytest.approx(-1.2050 / (3.0 * 0.000511))


# Far away on y = 0, where exp(x) overflows, the slope of the second formula is not a number.
@pytest.mark.parametrize("formula", [INVARIANT_AXIS, f"{INVARIANT_AXIS} + 1e-12 y² exp(x)"], ids=["all x", "overflow"])
def test_lines_along_an_axis_that_is_no_line_of_symmetry_leave_its_ridges_where_they_must(formula: str) -> None:
    # V_y = 0 on y = 0, but V is not even in y. DOP853, applied to x and log y, leads one line from each of these saddles to the
    # origin. The lines come as close as 1e-565 to y = 0.
    farthest = [[8.738163, -0.041898], [8.738564, 0.041888], [-6.969344, -0.058634], [-6.970453, 0.058622]]
    saddles = parse_formula(formula).saddles
    assert len(saddles) == 9
    for place in farthest:
        assert np.hypot(*(saddles - place).T).min() < 1e-6


def test_lines_of_steepest_ascent_end_at_maxima_outside_the_searched_region() -> None:
    potential = parse_formula(REMOTE_MAXIMUM)
    points = potential.critical_points
    saddles = np.flatnonzero(potential.well.critical_indices < 0)
    assert find_maxima_beside(potential.form, points, potential.well.critical_indices, saddles).shape == (6, 8)


def test_lines_of_steepest_ascent_end_where_v_is_flat_to_rounding() -> None:
    # The lines from both saddles lead to the middle of the ring, and outward, where V = 0 to rounding.
    wells = ("(x − 2)² − y²", "(x + 2)² − y²", "x² − (y − 2)²", "x² − (y + 2)²")
    potential = parse_formula("".join(f"− exp(−{well})" for well in wells) + "; well (0, −2)")
    assert (potential.channels, len(potential.well.channel_mergers)) == (2, 1)
    assert potential.well.channel_mergers[0].energy == pytest.approx(-4.0 * np.exp(-4.0))


def test_lines_that_pass_ridges_on_a_line_of_symmetry_end_at_the_origin() -> None:
    # DOP853, applied to x and log y, leads one line from each saddle to the origin and the other line to infinity. The first line
    # comes as close as 1e-15 to ridges on y = 0.
    farthest = [[21.004705446, 0.355237647], [-23.002791387, 0.342608490]]
    saddles = parse_formula(VALLEYS).saddles
    assert len(saddles) == 18
    for x, y in farthest:
        for image in ([x, y], [x, -y]):
            assert np.hypot(*(saddles - image).T).min() < 1e-8


@pytest.mark.parametrize("formula", [VALLEYS, exchanged(VALLEYS)], ids=["even in y", "even in x"])
def test_a_line_over_each_exit_falls_from_the_saddle_to_the_origin_and_outward(formula: str) -> None:
    potential = parse_formula(formula)
    for saddle, line in zip(potential.saddles, potential.well.exit_lines, strict=True):
        value = potential.value(*line.T)
        top = int(np.argmax(value))
        assert np.hypot(*line[0]) < 1e-3
        np.testing.assert_allclose(line[top], saddle, atol=1e-12)
        assert (np.diff(value[: top + 1]) > 0.0).all()
        assert (np.diff(value[top:]) < 0.0).all()


@pytest.mark.parametrize("seed", range(16))
def test_exits_of_symmetric_wells_and_their_lines_are_exact_mirror_images(seed: int) -> None:
    well = random_symmetric_well(seed).well
    assert well.mirrors
    lines = {tuple(saddle): line for saddle, line in zip(well.saddles.tolist(), well.exit_lines, strict=True)}
    for signs in well.mirrors:
        for saddle, line in lines.items():
            # The image of a saddle on an axis is the saddle, and its line stays on the axis.
            np.testing.assert_array_equal(lines[tuple((np.array(saddle) * signs).tolist())], line * signs)
