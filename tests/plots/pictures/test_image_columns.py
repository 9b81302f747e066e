"""Images of frames have the right pixel codes and positions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    compute_map,
)
from plots.layers.table import PICTURES
from plots.pictures import palette
from plots.pictures.image_columns import (
    difference_column,
    draw_over,
    map_columns,
    pixel_coding,
)
from plots.pictures.palette import DIFFERENCES, OUTCOMES, PAPER
from tests.disc import disc_map


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.18, (81, 61), window=(-1.0, 1.4, -0.8, 0.8), t_max=200.0)
    return compute_map(spec)


def test_every_pixel_has_the_colour_of_its_fate(escape_map: EscapeMap) -> None:
    colours = np.array(PICTURES["basins"].colours(PAPER))[map_columns(escape_map)["fate"][0]]
    for channel in (1, 2, 3):
        assert set(colours[escape_map.fate == channel]) == {PAPER.channels[channel - 1]}
    for fate in (Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE):
        assert set(colours[escape_map.fate == fate]) == {PAPER.outcomes[fate].colour}


def test_a_collision_has_a_colour_and_words_of_its_own() -> None:
    columns, fate = map_columns(frame := disc_map()), frame.fate
    assert set(np.array(PICTURES["basins"].colours(PAPER))[columns["fate"][0]][fate == 3]) == {PAPER.of_kinds["collision"][0]}
    (code,) = set(columns["fate"][0][fate == 3].tolist())
    assert columns["ends"][0][code - len(OUTCOMES)] == "collides with a disc"


@pytest.mark.parametrize(("crossings", "label"), [(0, "0 (direct)"), (2, "2"), (3, "3–10"), (11, "> 10")])
def test_escaped_pixels_are_classified_by_crossings(escape_map: EscapeMap, crossings: int, label: str) -> None:
    where = (escape_map.fate > 0) & (escape_map.crossings == crossings)
    assert where.any()
    codes = map_columns(escape_map)["crossing_class"][0][where]
    labels = [*palette.OUTCOMES.values(), *(label for _, label in palette.CROSSING_CLASSES)]
    assert {labels[code] for code in codes} == {label}


def test_a_coarse_frame_fills_the_window() -> None:
    frames: list[EscapeMap] = []
    compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (120, 120), t_max=50.0), on_frame=frames.append)
    coarse = frames[0]
    assert coarse.stride > 1
    columns, window = map_columns(coarse), coarse.spec.find_window()
    shown = columns["fate"][0]
    assert shown.size < coarse.fate.size / 4
    assert not np.any(shown == list(palette.OUTCOMES).index(Fate.NOT_COMPUTED))
    assert columns["x"][0] + columns["dw"][0] >= window.x_high
    assert columns["y"][0] + columns["dh"][0] >= window.ordinate_high


def columns_of(
    fate: list[list[int]], window: tuple[float, float, float, float], *, complete: bool = False
) -> dict[str, list[Any]]:
    """Return columns of a frame whose images all have these codes, row 0 lowest."""
    codes, (low, high, bottom, top) = np.array(fate, np.uint8), window
    images = {name: [codes] for name in ("fate", "crossing_class", "crossings", "escape_time")}
    return {**images, "x": [low], "y": [bottom], "dw": [high - low], "dh": [top - bottom], "complete": [complete]}


def test_undecided_pixels_show_those_of_an_earlier_map() -> None:
    earlier = columns_of([[7, 8], [9, 6]], (0.0, 2.0, 0.0, 2.0))
    frame = columns_of([[5, 0], [0, 0]], (0.0, 2.0, 0.0, 2.0))
    assert draw_over(frame, earlier, (2, 2))["fate"][0].tolist() == [[5, 8], [9, 6]]


def test_coarse_pixels_do_not_replace_finer_pixels_of_the_same_place() -> None:
    earlier = columns_of([[7, 8], [9, 6]], (0.0, 2.0, 0.0, 2.0))
    frame = columns_of([[5]], (0.0, 2.0, 0.0, 2.0))
    assert draw_over(frame, earlier, (4, 4))["fate"][0].tolist() == [[7, 8], [9, 6]]


def test_pixels_beyond_the_earlier_window_are_those_of_the_frame() -> None:
    earlier = columns_of([[7, 8]], (0.0, 2.0, 0.0, 1.0))
    frame = columns_of([[5, 4]], (1.0, 3.0, 0.0, 1.0))
    assert draw_over(columns_of([[0, 4]], (1.0, 3.0, 0.0, 1.0)), earlier, (2, 1))["fate"][0].tolist() == [[8, 4]]
    assert draw_over(frame, earlier, (2, 1))["fate"][0].tolist() == [[5, 4]]


def class_of_difference(one: int, other: int) -> int:
    """Return the code of a pixel whose orbits have these fates in two views. All cases are written out."""
    first = len(OUTCOMES)
    if Fate.NOT_COMPUTED in (one, other):
        return list(OUTCOMES).index(Fate.NOT_COMPUTED)
    without = [fate in (Fate.FORBIDDEN, Fate.OUTSIDE) for fate in (one, other)]
    if all(without):
        return list(OUTCOMES).index(Fate(one))
    if any(without):
        return first + 2
    return first + (one != other)


def test_pixels_of_two_views_are_compared_by_their_fates(escape_map: EscapeMap) -> None:
    other = compute_map(replace(escape_map.spec, energy=0.2))
    codes = difference_column(map_columns(escape_map), map_columns(other))["difference"][0]
    expected = [class_of_difference(*pair) for pair in zip(escape_map.fate.ravel(), other.fate.ravel(), strict=True)]
    np.testing.assert_array_equal(codes.ravel(), expected)
    assert set(codes.ravel()) >= {len(OUTCOMES) + k for k in range(len(DIFFERENCES))}


def test_other_programs_get_the_same_codes_of_differences(escape_map: EscapeMap) -> None:
    one, other = map_columns(escape_map), map_columns(compute_map(replace(escape_map.spec, energy=0.2)))
    table = np.array(pixel_coding(escape_map.spec.outcomes)["differences"])
    np.testing.assert_array_equal(table[one["fate"][0], other["fate"][0]], difference_column(one, other)["difference"][0])
