from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane
from engine.maps.row_blocks import row_blocks


@pytest.mark.parametrize("max_pixels", [1, 150])
@pytest.mark.parametrize("rows", [30, 31])
def test_blocks_contain_each_row_once_with_its_mirror_image(rows: int, max_pixels: int) -> None:
    blocks = list(row_blocks(MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, rows)), max_pixels))
    np.testing.assert_array_equal(np.sort(np.concatenate(blocks)), np.arange(rows))
    for block in blocks:
        assert block.size <= max(max_pixels // 30, 2)
        np.testing.assert_array_equal(block, np.sort(rows - 1 - block))
