"""Share of pixels whose outcomes are not reliable in double precision, estimated in deep zooms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.foundations.execution import Execution
from engine.maps.analyses.reruns import SAME_STARTS
from engine.maps.analyses.trust import TrustTest, find_unlike_neighbours
from engine.maps.result import PIXEL_ARRAYS, EscapeMap
from engine.maps.stages import run_to_frame

# Distance of pixels, in units of the well, below which the share is estimated.
_DEEP_PIXEL = 1e-7

# Approximate number of sampled pixels per side.
_SAMPLED_SIDE = 16


def with_rounded_share(escape_map: EscapeMap, execution: Execution) -> EscapeMap:
    """Return a map in units of the well with `EscapeMap.rounded_share`, which is estimated for complete deep zooms only.

    The estimate is the share of the interior pixels whose fate or crossings change with the errors of double precision. It is
    based on about `_SAMPLED_SIDE`² pixels, evenly spaced. Those that are bounded without evidence, or have another outcome than
    one of their neighbours in this sample, are integrated again from the same starts with `SECOND_TOLERANCE`, so that only the
    errors of the integration differ. The others count as unchanged. If an outcome changes, one of the two outcomes is wrong. The
    share of changes is therefore at most the sum of the shares of wrong pixels in both integrations.
    """
    spacings = (np.ptp(axis) / max(axis.size - 1, 1) for axis in (escape_map.x, escape_map.ordinate))
    # The spacing of a single row or column is 0.
    is_deep = escape_map.spec.plane.parameter is None and 0.0 < min(spacings) < _DEEP_PIXEL
    if not (escape_map.complete and is_deep):
        return escape_map
    sample = _sample_pixels(escape_map)
    test = TrustTest(sample, find_unlike_neighbours(sample.fate, sample.crossings), SAME_STARTS)
    share = run_to_frame(test, replace(execution, on_progress=None)).doubtful_share
    return escape_map if execution.is_cancelled else replace(escape_map, rounded_share=share)


def _sample_pixels(escape_map: EscapeMap) -> EscapeMap:
    """Return evenly spaced pixels of a map, with the request of the whole map."""
    row_step, column_step = (max(1, side // _SAMPLED_SIDE) for side in escape_map.fate.shape)
    rows, columns = slice(row_step // 2, None, row_step), slice(column_step // 2, None, column_step)
    arrays = {name: getattr(escape_map, name)[rows, columns] for name in PIXEL_ARRAYS}
    x, ordinate = escape_map.x[columns], escape_map.ordinate[rows]
    return replace(escape_map, x=x, ordinate=ordinate, batch=None, **arrays)
