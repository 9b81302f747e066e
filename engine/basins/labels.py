"""Which starts of a map count in a measure of its basins, and under which labels."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.dynamics.fates import Fate
from engine.validation import read_array

ENTROPY_COUNTS_BOUNDED = True
"""Whether bounded orbits are a label in the basin entropy. Yes: to stay is one of the ends that a start may come to."""

WADA_COUNTS_BOUNDED = False
"""Whether bounded orbits are a basin in the merging test. No: Wada is said of the exits (Aguirre, Vallejo & Sanjuán 2001).

The edge of an island of bounded orbits is no boundary between exits elsewhere, so with islands no picture would pass.
"""


def exit_labels(fate: np.ndarray, *, bounded: bool) -> tuple[np.ndarray, np.ndarray]:
    """The basins of escape of a map as labels, and which pixels count.

    Forbidden and outside starts never count, nor do those that are not decided yet or failed. A map under way therefore leaves
    out the orbits that leave late, which lie on the boundaries: it looks tamer than it will be.

    Parameters
    ----------
    fate
        (rows, columns) codes of a map, see `Fate`, finished or under way.
    bounded
        Whether bounded orbits are a label of their own, 0, or do not count; see `ENTROPY_COUNTS_BOUNDED` and
        `WADA_COUNTS_BOUNDED`.

    Returns
    -------
    labels, (rows, columns) int: the channel of each orbit that left, `Fate.BOUNDED` = 0 of each bounded one; and valid, bool of
    the same shape. Labels that do not count are whatever code the map holds. Both are read-only.
    """
    labels = fate.view()
    valid = (labels >= 1) | (bounded & (labels == Fate.BOUNDED))
    for array in (labels, valid):
        array.flags.writeable = False
    return labels, valid


def checked_labels(labels: Any, valid: Any) -> tuple[np.ndarray, np.ndarray]:
    """The labels as an array of integers and which of them count; ValueError unless both are (rows, columns)."""
    labels = read_array("labels", labels, keep_type=True)
    if labels.ndim != 2 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"labels of shape {labels.shape} and type {labels.dtype}: must be integers, (rows, columns)")
    if valid is None:
        return labels, np.ones(labels.shape, np.bool_)
    valid = read_array("valid", valid, keep_type=True)
    if valid.shape != labels.shape or valid.dtype != np.bool_:
        raise ValueError(
            f"valid of shape {valid.shape} and type {valid.dtype}: must be bool, shaped like the labels {labels.shape}"
        )
    return labels, valid
