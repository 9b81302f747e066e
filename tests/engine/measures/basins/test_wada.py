"""The merging test agrees with a comparison of all pixels, and tells Wada basins from others."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import product

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map
from engine.measures.basins.starts import exit_labels
from engine.measures.basins.wada import COUNTS_BOUNDED, WadaTest, compute_wada_test


def stripes(width: int, number: int = 3, rows: int = 10) -> np.ndarray:
    labels: np.ndarray = np.arange(number).repeat(width) * np.ones((rows, 1), int)
    return labels


def patches(seed: int, labels: int = 4, side: int = 24) -> np.ndarray:
    """Return random labels in squares of 3 × 3 pixels."""
    coarse = np.random.default_rng(seed).integers(labels, size=(side // 3, side // 3))
    return coarse.repeat(3, axis=0).repeat(3, axis=1)


def pixel_by_pixel(labels: np.ndarray, valid: np.ndarray) -> list[float]:
    """Return the distance of each boundary pixel from the furthest slim boundary, by comparing all pairs of pixels."""
    rows, columns = labels.shape
    slim: dict[int, set[tuple[int, int]]] = {int(label): set() for label in np.unique(labels[valid])}
    for (row, column), (down, right) in product(np.ndindex(rows, columns), [(0, 1), (1, 0)]):
        one, other = (row, column), (row + down, column + right)
        if other[0] < rows and other[1] < columns and valid[one] and valid[other] and labels[one] != labels[other]:
            slim[int(labels[one])] |= {one, other}
            slim[int(labels[other])] |= {one, other}
    return [
        max(
            min((max(abs(row - i), abs(column - j)) for i, j in boundary), default=math.inf)
            for boundary in slim.values()
        )
        for row, column in set().union(*slim.values())
    ]  # fmt: skip


def cantor_basins(level: int) -> np.ndarray:
    """Return three basins in 3**level columns: the gaps of the Cantor set, labelled in turn by size. The limit is Wada.

    Every point of the set has gaps of all three labels arbitrarily close.
    """
    labels = np.full(3**level, level % 3)
    place = np.arange(3**level)
    for size in range(level):
        digit = place // 3**size % 3
        labels[digit == 1] = (level - 1 - size) % 3
    return labels * np.ones((3, 1), int)


@cache
def exits(case: str, energy: float, side: int, bounded: bool = COUNTS_BOUNDED) -> WadaTest:
    frame = compute_map(MapSpec(CASES[case], Plane.X_PX, energy, (side, side), t_max=1e3))
    return compute_wada_test(*exit_labels(frame.fate, bounded=bounded))


# Images with known results.


@pytest.mark.parametrize("width", [2, 40])
def test_boundaries_of_stripes_are_one_width_apart(width: int) -> None:
    result = compute_wada_test(stripes(width))
    assert (result.radius, result.radius_99, result.boundary_pixels) == (width, width, 40)
    assert result.shares.tolist() == [0.0] * (width - 1) + [0.5, 1.0]


@pytest.mark.parametrize("seed", range(2))
def test_random_images_agree_with_comparing_all_pairs_of_pixels(seed: int) -> None:
    labels = patches(seed)
    valid = np.random.default_rng(seed).random(labels.shape) > 0.1
    reach = np.sort(pixel_by_pixel(labels, valid))
    result = compute_wada_test(labels, valid)
    assert result.boundary_pixels == reach.size
    assert result.radius == reach[-1]
    assert result.radius_99 == min(r for r in range(int(reach[-1]) + 1) if np.mean(reach <= r) >= 0.99)
    assert result.shares == pytest.approx([np.mean(reach <= r) for r in range(int(reach[-1]) + 1)])


@pytest.mark.parametrize("level", [4, 7])
def test_basins_around_a_cantor_set_have_the_same_radius_at_any_resolution(level: int) -> None:
    assert compute_wada_test(cantor_basins(level)).radius == 3


# Invariance, and pixels that do not count.


@pytest.mark.parametrize("transform", [np.fliplr, np.flipud, np.transpose, np.rot90, lambda labels: 20 - 3 * labels])
def test_rotation_reflection_and_relabelling_do_not_matter(transform: Callable[[np.ndarray], np.ndarray]) -> None:
    one, other = compute_wada_test(patches(1)), compute_wada_test(transform(patches(1)))
    assert (other.radius, other.radius_99, other.boundary_pixels) == (one.radius, one.radius_99, one.boundary_pixels)
    assert np.array_equal(other.shares, one.shares)


def test_invalid_pixels_form_no_boundary() -> None:
    labels = stripes(5)
    valid = labels != 1
    labels[~valid] = np.random.default_rng(0).integers(9, size=np.count_nonzero(~valid))
    result = compute_wada_test(labels, valid)
    assert result.basins == (0, 2)
    assert result.boundary_pixels == 0


def test_a_basin_that_touches_no_other_has_an_infinite_radius() -> None:
    labels = stripes(5)
    valid = np.ones(labels.shape, bool)
    valid[:, 10] = False
    result = compute_wada_test(labels, valid)
    assert result.radius == result.radius_99 == math.inf
    assert result.shares.size == 0
    assert "touches no other" in result.describe()


def test_the_test_needs_three_basins() -> None:
    result = compute_wada_test(stripes(5, 2))
    assert not result.is_applicable
    assert math.isnan(result.radius_99)
    assert result.shares.size == 0
    assert "needs three basins" in result.describe()


# Maps.


@pytest.mark.parametrize(("case", "energy", "side"), [("II", 0.2, 150), ("III", 0.45, 150)])
def test_the_boundaries_of_all_exits_have_a_small_radius_at_any_resolution(case: str, energy: float, side: int) -> None:
    """The basins of Hénon-Heiles (II) are Wada (Aguirre, Vallejo & Sanjuán 2001, PRE 64, 066208); four exits should be too."""
    result = exits(case, energy, side)
    assert len(result.basins) == CASES[case].channels
    assert result.radius <= 9
    assert result.radius_99 <= 3
