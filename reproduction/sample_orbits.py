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
        (x, y, px, py) by exit, of the orbit with the fewest crossings, but at least `SHOWN_CROSSINGS`, or with the most crossings
        if all have fewer. Of several, the first to escape is chosen, and of these the lowest and leftmost pixel.
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


def find_lyapunov_r2(potential: Potential, energy: float) -> tuple[float, float]:
    """Return the smallest and the largest R² = x² + y² on the Lyapunov orbits at an energy."""
    r2 = np.concatenate([orbit.x**2 + orbit.y**2 for orbit in find_lyapunov_orbits(potential, energy)])
    return float(r2.min()), float(r2.max())
