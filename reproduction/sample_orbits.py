"""Select one orbit through each exit of a map, and measure the Lyapunov orbits over the exits."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap, Potential, find_lyapunov_orbits

SHOWN_CROSSINGS = 3
"""Smallest number of upward crossings of y = 0 of a selected orbit."""


def find_sample_starts(frame: EscapeMap) -> dict[int, tuple[float, float, float, float]]:
    """Find a start for each exit through which an orbit of a map escapes.

    Parameters
    ----------
    frame
        A complete map of one energy.

    Returns
    -------
    dict
        (x, y, px, py) by exit. The selected orbit has the smallest number of crossings that is at least `SHOWN_CROSSINGS`, or the
        largest number if all orbits have fewer crossings. Among several such orbits, the first to escape is selected, then the
        lowest and leftmost pixel.
    """
    starts: dict[int, tuple[float, float, float, float]] = {}
    for channel in range(1, frame.spec.potential.channels + 1):
        rows, columns = np.nonzero(frame.fate == channel)
        if rows.size == 0:
            continue
        crossings = frame.crossings[rows, columns]
        has_enough = crossings >= SHOWN_CROSSINGS
        selected = int(crossings[has_enough].min()) if has_enough.any() else int(crossings.max())
        times = np.where(crossings == selected, frame.escape_time[rows, columns], np.inf)
        index = int(np.argmin(times))
        # `start_states` takes arrays, here of a single start.
        x, ordinate = frame.x[columns[index : index + 1]], frame.ordinate[rows[index : index + 1]]
        x_start, y_start, px_start, py_start = frame.spec.start_states(x, ordinate)[0].tolist()
        starts[channel] = (x_start, y_start, px_start, py_start)
    return starts


def find_lyapunov_r2(potential: Potential, energy: float) -> tuple[float, float]:
    """Return the smallest and the largest R² = x² + y² on the Lyapunov orbits at an energy."""
    r2 = np.concatenate([orbit.x**2 + orbit.y**2 for orbit in find_lyapunov_orbits(potential, energy)])
    return float(r2.min()), float(r2.max())
