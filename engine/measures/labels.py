"""Basin labels of a map, and which of its pixels count in a measure."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.validation import checked_array
from engine.measures.starts import read_starts
from engine.propagation.fates import Fate


def exit_labels(fate: np.ndarray, *, bounded: bool) -> tuple[np.ndarray, np.ndarray]:
    """Label the basins of escape of a map and select the pixels that count.

    Forbidden, outside, undecided and failed starts never count. An unfinished map therefore lacks the orbits that escape late,
    which lie on the basin boundaries, and appears less mixed than the finished map.

    Parameters
    ----------
    fate
        (rows, columns) integer `Fate` codes and outcomes of a map, finished or not.
    bounded
        Whether bounded orbits are a label of their own, 0, or do not count; each measure has its `COUNTS_BOUNDED`.

    Returns
    -------
    labels
        (rows, columns) int, a read-only view of `fate`: the outcome of escaping orbits, `Fate.BOUNDED` = 0 of bounded ones, and
        arbitrary codes where `valid` is False.
    valid
        (rows, columns) bool, the pixels that count; read-only.
    """
    valid = (fate >= 1) | (bounded & (fate == Fate.BOUNDED))
    return read_only(fate.view()), read_only(valid)


def describe_labels(labels: Any) -> dict[str, Any]:
    """How the map was made of which labels are given; empty for an array."""
    return dict(read_starts("labels", labels).made_by) if hasattr(labels, "fate") else {}


def checked_labels(labels: Any, valid: Any, *, bounded: bool) -> tuple[np.ndarray, np.ndarray]:
    """`labels` as integers and `valid` as bool, both (rows, columns), of a map those of `exit_labels`.

    Raises
    ------
    ValueError
        For any other shape or type, and for negative labels without `valid`: they are codes of starts without an outcome.
    """
    if hasattr(labels, "fate"):
        labels, valid = exit_labels(read_starts("labels", labels).fate, bounded=bounded)
    labels = checked_array("labels", labels, keep_type=True)
    if labels.ndim != 2 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"labels of shape {labels.shape} and type {labels.dtype}: must be integers, (rows, columns)")
    if valid is None:
        if labels.size and labels.min() < 0:
            raise ValueError(
                f"labels: {np.count_nonzero(labels < 0)} are negative, the codes of starts without an outcome; "
                "give the map itself, or valid=(labels >= 0)"
            )
        return labels, np.ones(labels.shape, np.bool_)
    valid = checked_array("valid", valid, keep_type=True)
    if valid.shape != labels.shape or valid.dtype != np.bool_:
        raise ValueError(
            f"valid of shape {valid.shape} and type {valid.dtype}: must be bool, shaped like the labels {labels.shape}"
        )
    return labels, valid
