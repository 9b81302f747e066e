"""One orbit through each channel, chosen from a map by a rule, for a figure to show."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap

SHOWN_CROSSINGS = 3
"""Upward crossings of y = 0 that a shown orbit makes, or a few more: enough to see it wander, few enough to follow it."""


def find_sample_starts(frame: EscapeMap) -> dict[int, tuple[float, float, float, float]]:
    """A start for each channel that any orbit of a map leaves by.

    Parameters
    ----------
    frame
        A complete map of one energy.

    Returns
    -------
    By channel, x, y, px, py of the orbit with the fewest crossings from `SHOWN_CROSSINGS` on (else the most there are), of these
    the one that leaves first, of these the lowest and leftmost pixel.
    """
    found: dict[int, tuple[float, float, float, float]] = {}
    for channel in range(1, frame.spec.potential.channels + 1):
        rows, columns = np.nonzero(frame.fate == channel)
        if rows.size == 0:
            continue
        crossings = frame.crossings[rows, columns]
        enough = crossings >= SHOWN_CROSSINGS
        wanted = int(crossings[enough].min()) if enough.any() else int(crossings.max())
        times = np.where(crossings == wanted, frame.escape_time[rows, columns], np.inf)
        place = int(np.argmin(times))
        x, ordinate = frame.x[columns[place : place + 1]], frame.ordinate[rows[place : place + 1]]
        first, second, third, fourth = frame.spec.start_states(x, ordinate)[0].tolist()
        found[channel] = (first, second, third, fourth)
    return found
