"""Random starts, uniform on the energy surface or on a slice."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.exits.interior import find_outside_channels
from engine.foundations.validation import RandomNumbers, checked_count, checked_generator, checked_number, checks_types
from engine.slices.default_window import default_window
from engine.slices.planes import ENERGY_SURFACE, SPACE, checked_slice
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow, Window, checked_window
from engine.systems.potential import Potential

LARGEST_SAMPLE = 10_000_000
"""Largest number of starts of one sample."""

# Largest number of points drawn at once.
_LARGEST_BATCH = 1_000_000
# Smallest number of points drawn at once.
_SMALLEST_BATCH = 1_000
# Smallest share of points inside at which a window has an interior.
_SMALLEST_INSIDE_SHARE = 1e-4


@checks_types(potential=Potential)
def sample_starts(
    potential: Potential,
    energy: float,
    count: int,
    *,
    plane: Slice | str | None = None,
    window: GivenWindow | None = None,
    rng: RandomNumbers = None,
) -> np.ndarray:
    """Draw random starts inside all exits.

    On the energy surface, starts have the microcanonical measure δ(H − h) dx dy dpx dpy: with two degrees of freedom, positions
    are uniform where V ≤ h, and the directions of the velocity are uniform. On a slice, starts are uniform in both axes.

    Parameters
    ----------
    potential
        The potential.
    energy
        h, finite, dimensionless.
    count
        Number of starts, 1 to 10 000 000.
    plane
        The slice, such as a `Plane`, of one energy and one potential; None for the energy surface.
    window
        Part of the slice, or of (x, y) on the energy surface, given as in `MapSpec`; None for the whole interior.
    rng
        Random numbers: a seed, 0 to 2⁶³ − 1, of which equal ones give equal starts, or a NumPy generator; None for new numbers.

    Returns
    -------
    x, y, px, py of each start, of shape (count, 4). Their energies are equal to `energy` up to rounding.

    Raises
    ------
    ValueError
        If a parameter is out of range, the slice has an axis h or a parameter, or no part of the window is inside.

    Examples
    --------
    >>> from escape_explorer import CASES, classify_orbits, sample_starts
    >>> starts = sample_starts(CASES["III"], 0.45, 1000, rng=1)
    >>> outcomes = classify_orbits(CASES["III"], 0.45, starts, t_max=100.0)
    >>> [round(float((outcomes.fate == channel).mean()), 2) for channel in (1, 2, 3, 4)]
    [0.24, 0.22, 0.22, 0.23]
    """
    h = checked_number("energy", energy)
    count = checked_count("count", count, 1, LARGEST_SAMPLE)
    generator = checked_generator(rng)
    window_plane = SPACE if plane is None else checked_slice(plane)
    window_plane.check_one_potential("plane")
    if window_plane.energy_axis is not None:
        raise ValueError(f"plane={window_plane.title}: must have no axis h, as all starts have one energy")
    drawn_window = default_window(potential, window_plane, h) if window is None else checked_window(window)
    batches = [np.empty((0, 4))]
    drawn_count = inside_count = 0
    while inside_count < count:
        # A fifth more points than are expected to contain the missing starts.
        expected_size = 1.2 * (count - inside_count) * (drawn_count + 1) / (inside_count + 1)
        size = int(np.clip(expected_size, _SMALLEST_BATCH, _LARGEST_BATCH))
        batches.append(_draw(potential, h, None if plane is None else window_plane, drawn_window, size, generator))
        drawn_count += size
        inside_count += len(batches[-1])
        if inside_count < _SMALLEST_INSIDE_SHARE * drawn_count:
            raise ValueError(f"window={drawn_window}: nothing of it is inside at h={h}; must contain starts inside all exits")
    return np.concatenate(batches)[:count]


def _draw(
    potential: Potential, h: float, plane: Slice | None, window: Window, size: int, generator: np.random.Generator
) -> np.ndarray:
    """Draw `size` random points of a window, or of the energy surface without a plane, and return the starts inside, (n, 4)."""
    x, ordinate = (generator.uniform(low, high, size) for low, high in window.ranges)
    states = (plane or ENERGY_SURFACE).states(potential, h, x, ordinate)
    states = states[np.isfinite(states).all(axis=1)]
    states = states[find_outside_channels(potential, h, *np.ascontiguousarray(states[:, :2].T)) == 0]
    return states if plane is not None else _turn_randomly(states, generator)


def _turn_randomly(states: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    """Return states with velocities in random directions."""
    speed: Any = np.hypot(states[:, 2], states[:, 3])
    angle = generator.uniform(0.0, 2.0 * np.pi, len(states))
    return np.column_stack([states[:, :2], speed * np.cos(angle), speed * np.sin(angle)])
