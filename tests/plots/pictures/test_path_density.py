"""Long paths are shaded by how often they pass each pixel."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Window
from plots.pictures.path_density import FAINTEST, PIXELS, count_passes, shade_path

UNIT = Window(0.0, 1.0, 0.0, 1.0)
MIDDLE = (np.arange(PIXELS) + 0.5) / PIXELS
# Outside, in the middle of a pixel.
LEFT, RIGHT = MIDDLE[0] - 0.1, MIDDLE[-1] + 0.1


def test_a_line_passes_each_of_its_pixels_once() -> None:
    counts = count_passes(np.array([LEFT, RIGHT]), np.full(2, MIDDLE[7]), UNIT)
    assert counts[7].tolist() == [1] * PIXELS
    assert counts.sum() == PIXELS


@pytest.mark.parametrize("points", [2, 10_001])
def test_a_diagonal_has_no_gaps_however_it_is_divided(points: int) -> None:
    t = np.linspace(LEFT, RIGHT, points)
    counts = count_passes(t, t, UNIT)
    assert (np.diagonal(counts) > 0).all()
    assert np.count_nonzero(counts) == PIXELS


def test_opacity_follows_the_rank_of_the_number_of_passes() -> None:
    # Row 3 once, row 9 twice, row 20 a hundred times.
    rows = [3] + [9] * 2 + [20] * 100
    x = np.tile([LEFT, RIGHT], len(rows))
    y = np.repeat(MIDDLE[rows], 2)
    # Between two lines the path is outside the window.
    x, y = np.insert(x, np.arange(2, len(x), 2), 3.0), np.insert(y, np.arange(2, len(y), 2), 0.0)
    shaded = shade_path(x, np.where(x == 3.0, -9.0, y), UNIT)
    once, twice, often = (shaded[row, PIXELS // 2] for row in (3, 9, 20))
    assert once == FAINTEST < twice < often == 255
    assert not shaded[30:].any()
