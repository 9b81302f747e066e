from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import product

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map
from engine.basins.labels import WADA_COUNTS_BOUNDED, exit_labels
from engine.basins.wada import WadaTest, compute_wada_test


def stripes(width: int, number: int = 3, rows: int = 10) -> np.ndarray:
    labels: np.ndarray = np.arange(number).repeat(width) * np.ones((rows, 1), int)
    return labels


def patches(seed: int, labels: int = 4, side: int = 24) -> np.ndarray:
    """A few pixels a side, at random."""
    coarse = np.random.default_rng(seed).integers(labels, size=(side // 3, side // 3))
    return coarse.repeat(3, axis=0).repeat(3, axis=1)


def pixel_by_pixel(labels: np.ndarray, valid: np.ndarray) -> list[float]:
    """For each boundary pixel the distance of the furthest slim boundary, found by looking at all pairs of pixels."""
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
    """Three basins that are Wada in the limit: the gaps of the middle-third set, taken in turn by their size.

    Every point of that set has gaps of all three kinds arbitrarily near. 3**level columns.
    """
    labels = np.full(3**level, level % 3)
    place = np.arange(3**level)
    for size in range(level):
        digit = place // 3**size % 3
        labels[digit == 1] = (level - 1 - size) % 3
    return labels * np.ones((3, 1), int)


@cache
def newton(side: int) -> WadaTest:
    """The basins of Newton's method for z³ = 1, −2 to 2; they have one common boundary, its Julia set."""
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


# Pictures with known answers.


@pytest.mark.parametrize("width", [2, 5, 40])
def test_straight_stripes_have_boundaries_a_stripe_apart(width: int) -> None:
    result = compute_wada_test(stripes(width))
    assert (result.radius, result.radius_99, result.boundary_pixels) == (width, width, 40)
    assert result.shares.tolist() == [0.0] * (width - 1) + [0.5, 1.0]


def test_stripes_one_pixel_wide_coincide_within_one() -> None:
    result = compute_wada_test(np.arange(12) % 3 * np.ones((7, 1), int))
    assert result.radius == 1
    assert result.shares.tolist() == pytest.approx([10 / 12, 1.0])


def test_a_picture_written_down_by_hand() -> None:
    labels = np.array([[4, 4, 4, 4, 4], [4, 4, 4, 4, 4], [4, 4, 4, 4, 4], [4, 4, 4, 0, 0], [4, 4, 4, 0, -2]])
    # On the boundary of -2: itself, (3, 4) and (4, 3). On that of 4: its four pixels beside the corner and the three pixels 0. On
    # that of 0: all these. So (3, 4) and (4, 3) are on all three, and the rest are next to one of these two.
    result = compute_wada_test(labels)
    assert result.basins == (-2, 0, 4)
    assert result.boundary_pixels == 8
    assert result.shares.tolist() == pytest.approx([2 / 8, 1.0])


@pytest.mark.parametrize("seed", range(6))
def test_any_picture_agrees_with_looking_at_all_pairs_of_pixels(seed: int) -> None:
    labels = patches(seed)
    valid = np.random.default_rng(seed).random(labels.shape) > 0.1
    reach = np.sort(pixel_by_pixel(labels, valid))
    result = compute_wada_test(labels, valid)
    assert result.boundary_pixels == reach.size
    assert result.radius == reach[-1]
    assert result.radius_99 == min(r for r in range(int(reach[-1]) + 1) if np.mean(reach <= r) >= 0.99)
    assert result.shares == pytest.approx([np.mean(reach <= r) for r in range(int(reach[-1]) + 1)])


@pytest.mark.parametrize("level", [4, 5, 6, 7])
def test_basins_around_a_cantor_set_coincide_within_pixels_however_fine_the_picture(level: int) -> None:
    assert compute_wada_test(cantor_basins(level)).radius == 3


def test_the_basins_of_newtons_method_coincide_within_pixels_however_fine_the_picture() -> None:
    for side in (200, 400, 800):
        assert newton(side).radius <= 6
        assert newton(side).radius_99 == 2


def test_the_radius_is_where_all_boundary_pixels_are_held() -> None:
    result = newton(200)
    assert np.all(np.diff(result.shares) >= 0)
    assert result.shares.size == result.radius + 1
    assert result.shares[-2] < result.shares[-1] == 1.0


# What cannot matter, and what does not count.


@pytest.mark.parametrize("turned", [np.fliplr, np.flipud, np.transpose, np.rot90, lambda labels: 5 - 3 * labels])
def test_turned_mirrored_and_relabelled_pictures_have_the_same_answer(turned: Callable[[np.ndarray], np.ndarray]) -> None:
    one, other = compute_wada_test(patches(1)), compute_wada_test(turned(patches(1)))
    assert (other.radius, other.radius_99, other.boundary_pixels) == (one.radius, one.radius_99, one.boundary_pixels)
    assert np.array_equal(other.shares, one.shares)


def test_pixels_that_do_not_count_make_no_boundary() -> None:
    labels = stripes(5)
    valid = labels != 1
    labels[~valid] = np.random.default_rng(0).integers(9, size=np.count_nonzero(~valid))
    result = compute_wada_test(labels, valid)
    assert result.basins == (0, 2)
    assert result.boundary_pixels == 0


def test_a_basin_that_touches_no_other_is_infinitely_far() -> None:
    labels = stripes(5)
    valid = np.ones(labels.shape, bool)
    valid[:, 10] = False
    result = compute_wada_test(labels, valid)
    assert result.radius == result.radius_99 == math.inf
    assert result.shares.size == 0
    assert "touches no other" in result.describe()


def test_basins_without_any_boundary_are_no_question() -> None:
    labels = stripes(5)
    valid = np.ones(labels.shape, bool)
    valid[:, [5, 10]] = False
    result = compute_wada_test(labels, valid)
    assert not result.is_question
    assert "no two of the 3 basins touch" in result.describe()


@pytest.mark.parametrize("number", [1, 2])
def test_fewer_than_three_basins_are_no_question(number: int) -> None:
    result = compute_wada_test(stripes(5, number))
    assert not result.is_question
    assert math.isnan(result.radius_99)
    assert result.shares.size == 0
    assert "no question" in result.describe()


def test_where_nothing_counts_there_is_no_question() -> None:
    assert compute_wada_test(stripes(5), np.zeros((10, 15), bool)).basins == ()


def test_the_sentence_gives_both_radii() -> None:
    assert compute_wada_test(stripes(7)).describe() == (
        "The boundaries of the 3 basins coincide within 7 pixels, 99 % of the 40 on them within 7."
    )


def test_the_shares_are_read_only() -> None:
    assert not compute_wada_test(stripes(5)).shares.flags.writeable


@pytest.mark.parametrize(
    ("parameter", "labels", "valid"), [("labels", np.zeros((9, 9)), None), ("valid", stripes(3), np.ones(9))]
)
def test_what_is_not_legal_is_named(parameter: str, labels: np.ndarray, valid: np.ndarray | None) -> None:
    with pytest.raises(ValueError, match=f"^{parameter}"):
        compute_wada_test(labels, valid)


# Maps.


@pytest.mark.parametrize(("case", "energy"), [("II", 0.2), ("II", 0.25), ("III", 0.45)])
@pytest.mark.parametrize("side", [150, 450])
def test_the_boundaries_of_all_exits_coincide_within_pixels_however_fine_the_map(case: str, energy: float, side: int) -> None:
    """Those of Hénon-Heiles (II) are Wada, and four exits should do no worse: Aguirre, Vallejo & Sanjuán 2001, PRE 64, 066208."""
    result = exits(case, energy, side)
    assert len(result.basins) == CASES[case].channels
    assert result.radius <= 9
    assert result.radius_99 <= 3


def test_islands_of_bounded_orbits_are_no_basin_beside_the_exits() -> None:
    assert exits("II", 0.2, 150, True).radius > 0.2 * 150
    assert exits("II", 0.2, 300, True).radius > 0.2 * 300


def test_with_two_exits_wada_is_no_question() -> None:
    assert exits("I", 0.2, 100).basins == (1, 2)
    assert not exits("I", 0.2, 100).is_question
