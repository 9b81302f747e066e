from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane
from engine.maps.row_blocks import row_blocks


@pytest.mark.parametrize("max_pixels", [1, 30, 150, 10_000])
@pytest.mark.parametrize(("plane", "energy"), [(Plane.X_Y, 0.4), (Plane.X_PX, 0.4), (Plane.X_H, (0.3, 0.5))])
@pytest.mark.parametrize("rows", [1, 30, 31])
def test_blocks_contain_each_row_once(plane: Plane, energy: float, rows: int, max_pixels: int) -> None:
    blocks = list(row_blocks(MapSpec(CASES["III"], plane, energy, (30, rows)), max_pixels))
    np.testing.assert_array_equal(np.sort(np.concatenate(blocks)), np.arange(rows))
    fewest_rows = 2 if plane is Plane.X_PX else 1
    assert all(block.size <= max(max_pixels // 30, fewest_rows) for block in blocks)


def test_blocks_on_x_px_contain_the_mirror_images_of_their_rows() -> None:
    for block in row_blocks(MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, 31)), 150):
        np.testing.assert_array_equal(block, np.sort(30 - block))
