from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import product

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map
from engine.measures.labels import WADA_COUNTS_BOUNDED, exit_labels
from engine.measures.wada import WadaTest, compute_wada_test


def stripes(width: int, number: int = 3, rows: int = 10) -> np.ndarray:
    labels: np.ndarray = np.arange(number).repeat(width) * np.ones((rows, 1), int)
    return labels


def patches(seed: int, labels: int = 4, side: int = 24) -> np.ndarray:
    """Random labels in squares of 3 × 3 pixels."""
    coarse = np.random.default_rng(seed).integers(labels, size=(side // 3, side // 3))
    return coarse.repeat(3, axis=0).repeat(3, axis=1)


def pixel_by_pixel(labels: np.ndarray, valid: np.ndarray) -> list[float]:
    """Distance of each boundary pixel from the furthest slim boundary, by comparing all pairs of pixels."""
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
    """Three basins that are Wada in the limit, with 3**level columns: the gaps of the Cantor set, labelled in turn by their size.

    Every point of that set has gaps of all three labels arbitrarily close.
    """
    labels = np.full(3**level, level % 3)
    place = np.arange(3**level)
    for size in range(level):
        digit = place // 3**size % 3
        labels[digit == 1] = (level - 1 - size) % 3
    return labels * np.ones((3, 1), int)


@cache
def newton(side: int) -> WadaTest:
    """The basins of Newton's method for z³ = 1 on −2 to 2, whose common boundary is the Julia set."""
    place = (2.0 * np.arange(side) + 1.0 - side) / side * 2.0
    z = place + 1j * place[:, None]
    for _ in range(40):
        z = z - (z**3 - 1.0) / (3.0 * z * z)
    roots = np.exp(2j * np.pi * np.arange(3) / 3)
    return compute_wada_test(np.argmin(np.abs(z[..., None] - roots), axis=-1))


@cache
def exits(case: str, energy: float, side: int, bounded: bool = WADA_COUNTS_BOUNDED) -> WadaTest:
    frame = compute_map(MapSpec(CASES[case], Plane.X_PX, energy, (side, side), t_max=1e3))
    return compute_wada_test(*exit_labels(frame.fate, bounded=bounded))


# Images with known results.


@pytest.mark.parametrize("width", [2, 5, 40])
def test_boundaries_of_stripes_are_one_width_apart(width: int) -> None:
    result = compute_wada_test(stripes(width))
    assert (result.radius, result.radius_99, result.boundary_pixels) == (width, width, 40)
    assert result.shares.tolist() == [0.0] * (width - 1) + [0.5, 1.0]


def test_boundaries_of_stripes_one_pixel_wide_coincide_within_one_pixel() -> None:
    result = compute_wada_test(np.arange(12) % 3 * np.ones((7, 1), int))
    assert result.radius == 1
    assert result.shares.tolist() == pytest.approx([10 / 12, 1.0])


def test_a_small_image() -> None:
    labels = np.array([[4, 4, 4, 4, 4], [4, 4, 4, 4, 4], [4, 4, 4, 4, 4], [4, 4, 4, 0, 0], [4, 4, 4, 0, 7]])
    # The boundary of 7 consists of its pixel, (3, 4) and (4, 3), that of 4 of its four pixels beside the corner and the three
    # pixels 0, and that of 0 of all these. So (3, 4) and (4, 3) are on all three boundaries, and the others are next to one of
    # these two.
    result = compute_wada_test(labels)
    assert result.basins == (0, 4, 7)
    assert result.boundary_pixels == 8
    assert result.shares.tolist() == pytest.approx([2 / 8, 1.0])


@pytest.mark.parametrize("seed", range(6))
def test_random_images_agree_with_comparing_all_pairs_of_pixels(seed: int) -> None:
    labels = patches(seed)
    valid = np.random.default_rng(seed).random(labels.shape) > 0.1
    reach = np.sort(pixel_by_pixel(labels, valid))
    result = compute_wada_test(labels, valid)
    assert result.boundary_pixels == reach.size
    assert result.radius == reach[-1]
    assert result.radius_99 == min(r for r in range(int(reach[-1]) + 1) if np.mean(reach <= r) >= 0.99)
    assert result.shares == pytest.approx([np.mean(reach <= r) for r in range(int(reach[-1]) + 1)])


@pytest.mark.parametrize("seed", range(8))
def test_at_most_one_percent_of_the_boundary_pixels_are_further_than_radius_99(seed: int) -> None:
    result = compute_wada_test(np.kron(np.random.default_rng(seed).integers(0, 3, (5, 5)), np.ones((6, 6), int)))
    assert result.boundary_pixels >= 100
    assert result.radius_99 == np.argmax(result.shares >= 0.99)


@pytest.mark.parametrize("level", [4, 5, 6, 7])
def test_basins_around_a_cantor_set_have_the_same_radius_at_any_resolution(level: int) -> None:
    assert compute_wada_test(cantor_basins(level)).radius == 3


def test_newtons_basins_have_a_small_radius_at_any_resolution() -> None:
    for side in (200, 400):
        assert newton(side).radius <= 6
        assert newton(side).radius_99 == 2


def test_the_shares_reach_1_at_the_radius() -> None:
    result = newton(200)
    assert np.all(np.diff(result.shares) >= 0)
    assert result.shares.size == result.radius + 1
    assert result.shares[-2] < result.shares[-1] == 1.0


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


def test_the_test_needs_basins_that_touch() -> None:
    labels = stripes(5)
    valid = np.ones(labels.shape, bool)
    valid[:, [5, 10]] = False
    result = compute_wada_test(labels, valid)
    assert not result.is_applicable
    assert result.describe() == "The Wada test needs basins that touch; none of these 3 do."


@pytest.mark.parametrize(("number", "word"), [(1, "one"), (2, "two")])
def test_the_test_needs_three_basins(number: int, word: str) -> None:
    result = compute_wada_test(stripes(5, number))
    assert not result.is_applicable
    assert math.isnan(result.radius_99)
    assert result.shares.size == 0
    assert result.describe() == f"The Wada test needs three basins; this view has {word}."


def test_without_valid_pixels_there_are_no_basins() -> None:
    result = compute_wada_test(stripes(5), np.zeros((10, 15), bool))
    assert result.basins == ()
    assert result.describe() == "The Wada test needs three basins; this view has none."


def test_the_sentence_gives_both_radii() -> None:
    assert compute_wada_test(stripes(7)).describe() == (
        "The boundaries of the 3 basins coincide within 7 pixels, 99 % of the 40 boundary pixels within 7."
    )


def test_the_shares_are_read_only() -> None:
    assert not compute_wada_test(stripes(5)).shares.flags.writeable


@pytest.mark.parametrize(
    ("parameter", "labels", "valid"), [("labels", np.zeros((9, 9)), None), ("valid", stripes(3), np.ones(9))]
)
def test_invalid_parameters_are_named(parameter: str, labels: np.ndarray, valid: np.ndarray | None) -> None:
    with pytest.raises(ValueError, match=f"^{parameter}"):
        compute_wada_test(labels, valid)


# Maps.


@pytest.mark.parametrize(("case", "energy"), [("II", 0.2), ("II", 0.25), ("III", 0.45)])
@pytest.mark.parametrize("side", [150, 300])
def test_the_boundaries_of_all_exits_have_a_small_radius_at_any_resolution(case: str, energy: float, side: int) -> None:
    """The basins of Hénon-Heiles (II) are Wada (Aguirre, Vallejo & Sanjuán 2001, PRE 64, 066208); four exits should be too."""
    result = exits(case, energy, side)
    assert len(result.basins) == CASES[case].channels
    assert result.radius <= 9
    assert result.radius_99 <= 3


def test_islands_as_a_basin_have_a_radius_that_grows_with_the_resolution() -> None:
    assert exits("II", 0.2, 150, True).radius > 0.2 * 150
    assert exits("II", 0.2, 300, True).radius > 0.2 * 300


def test_the_test_does_not_apply_to_two_exits() -> None:
    assert exits("I", 0.2, 100).basins == (1, 2)
    assert not exits("I", 0.2, 100).is_applicable
