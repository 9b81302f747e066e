"""Points and vectors become exact mirror images of each other."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.systems.landscape.mirror_images import MIRROR_X, MIRROR_Y, find_images, make_symmetric, mirrors_of, without_rounding

# One point in each quadrant, each with an error of its own, and two points on the axes.
POINTS = np.array([[1.0 + 1e-15, 2.0], [-1.0, 2.0 + 1e-15], [-1.0 - 1e-15, -2.0], [1.0, -2.0 - 1e-15], [3.0, 0.0], [-3.0, 0.0]])


@pytest.mark.parametrize(("term", "count"), [("xy²", 1), ("x²y", 1), ("x²y²", 3), ("(x³ + y³)", 0)])
def test_a_potential_even_in_both_coordinates_also_has_the_rotation_by_180_degrees(term: str, count: int) -> None:
    assert len(mirrors_of(parse_formula(f"½(x² + y²) − {term}").form)) == count


def test_the_image_of_a_point_on_an_axis_is_the_point() -> None:
    assert find_images(POINTS, MIRROR_Y).tolist() == [3, 2, 1, 0, 4, 5]
    assert find_images(POINTS, MIRROR_X).tolist() == [1, 0, 3, 2, 5, 4]


def test_all_images_are_exact_copies_of_the_point_in_the_first_quadrant() -> None:
    symmetric = make_symmetric(POINTS, POINTS, [MIRROR_X, MIRROR_Y])
    np.testing.assert_array_equal(np.abs(symmetric[:4]), np.tile(POINTS[0], (4, 1)))
    np.testing.assert_array_equal(np.sign(symmetric), np.sign(POINTS))


def test_vectors_without_a_symmetry_stay_as_they_are() -> None:
    np.testing.assert_array_equal(make_symmetric(POINTS, POINTS, []), POINTS)


def test_rounding_errors_of_zero_become_zero_and_small_points_stay() -> None:
    points = np.array([[5.0, 1e-15], [1e-15, 1e-15], [0.0, 0.0]])
    np.testing.assert_array_equal(without_rounding(points), [[5.0, 0.0], [1e-15, 1e-15], [0.0, 0.0]])
