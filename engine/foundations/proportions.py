"""Confidence intervals of shares."""

from __future__ import annotations

from typing import Any

import numpy as np

Z_95 = 1.959963984540054
"""Half-width of the central 95 % of the normal distribution, in standard deviations."""


def wilson_interval(counts: Any, totals: Any) -> tuple[np.ndarray, np.ndarray]:
    """95 % score interval of a share (Wilson 1927, Journal of the American Statistical Association 22, 209).

    The interval holds for independent random draws. Starts on a grid scatter less.

    Parameters
    ----------
    counts
        Numbers of successes, 0 to `totals`, of any shape.
    totals
        Numbers of draws, of a shape that broadcasts with `counts`.

    Returns
    -------
    low, high
        Limits between 0 and 1, of the common shape; 0 and 1 without draws.
    """
    counts, totals = np.broadcast_arrays(np.asarray(counts, float), np.asarray(totals, float))
    drawn = np.maximum(totals, 1.0)
    share, spread = counts / drawn, Z_95**2 / drawn
    middle = (share + spread / 2) / (1 + spread)
    half_width = np.sqrt(spread * share * (1 - share) + spread**2 / 4) / (1 + spread)
    some = totals > 0.0
    return np.where(some, np.maximum(middle - half_width, 0.0), 0.0), np.where(some, np.minimum(middle + half_width, 1.0), 1.0)
