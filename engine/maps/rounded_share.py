"""How many pixels of a map double precision does not support."""

from __future__ import annotations

from dataclasses import replace

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.maps.reruns import SAME_STARTS
from engine.maps.result import PIXEL_ARRAYS, EscapeMap
from engine.maps.stages import run_to_frame
from engine.maps.trust import TrustTest, find_unlike_neighbours

SAMPLED_SIDE = 16
"""About this number of pixels per side are sampled for `estimate_rounded_share`."""


def estimate_rounded_share(escape_map: EscapeMap, execution: Execution = DEFAULT_EXECUTION) -> float:
    """Estimate for which share of the pixels of a complete map double precision gives another fate or number of crossings.

    Some `SAMPLED_SIDE`² pixels, evenly spread, are integrated again from the same starts with `SECOND_TOLERANCE`, so that only
    errors of the integration differ. Where the outcome changes, one of the two is wrong: the share is at most the sum of both
    shares of wrong pixels, and at least their difference.

    Parameters
    ----------
    escape_map
        A complete map of one potential.
    execution
        How the computation runs.

    Returns
    -------
    The share of the sampled interior pixels whose fate or number of crossings changes, 0 to 1; NaN if none is interior.
    """
    thinned = _thinned(escape_map)
    unlike = find_unlike_neighbours(thinned.fate, thinned.crossings)
    return run_to_frame(TrustTest(thinned, unlike, SAME_STARTS), execution).doubtful_share


def _thinned(escape_map: EscapeMap) -> EscapeMap:
    """Evenly spread pixels of a map, with the request of the whole map."""
    down, right = (max(1, side // SAMPLED_SIDE) for side in escape_map.fate.shape)
    arrays = {name: getattr(escape_map, name)[down // 2 :: down, right // 2 :: right] for name in PIXEL_ARRAYS}
    x, ordinate = escape_map.x[right // 2 :: right], escape_map.ordinate[down // 2 :: down]
    return replace(escape_map, x=x, ordinate=ordinate, batch=None, **arrays)
