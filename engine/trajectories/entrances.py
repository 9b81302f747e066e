"""Random orbits that enter a well through its exits. Their times inside are the gap times of transition state theory."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.exits.interior import find_outside_channels
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.lyapunov_orbits import find_lyapunov_orbits
from engine.foundations.validation import RandomNumbers, checked_count, checked_generator, checked_number, checks_types
from engine.slices.sampling import LARGEST_SAMPLE
from engine.systems.potential import Potential

# Number of points along half a Lyapunov orbit at which the flux is summed.
_POINTS = 2001
# Distance of the starts from the exit line, as a share of its length; at 0, rounding would decide which starts are inside.
_SHIFT = 1e-7


@checks_types(potential=Potential)
def sample_entrances(potential: Potential, energy: float, count: int, *, rng: RandomNumbers = None) -> np.ndarray:
    """Draw random states of orbits that enter the well through its exits, with the distribution of the flux.

    Orbits enter through each exit in proportion to its flux. The times until they leave are the gap times (Ezra, Waalkens &
    Wiggins 2009, J. Chem. Phys. 130, 164118). Their mean is `EscapeFlux.mean_passage_time` if orbits that never leave occupy no
    volume. The time of an orbit that is still inside at t_max is NaN; if NaN is replaced by t_max, as in the example, the mean is
    a lower bound.

    Parameters
    ----------
    potential
        The potential.
    energy
        h, above the escape energy, dimensionless.
    count
        Number of states, 1 to 10 000 000.
    rng
        Random numbers: a seed, 0 to 2⁶³ − 1, of which equal ones give equal states, or a NumPy generator; None for new numbers.

    Returns
    -------
    x, y, px, py of each state, of shape (count, 4), just inside the exits. Their energies are equal to `energy` up to rounding.

    Raises
    ------
    ValueError
        If a parameter is out of range, all exits are closed at this energy, or the frame rotates.

    Examples
    --------
    >>> import numpy as np
    >>> from escape_explorer import CASES, classify_orbits, compute_flux, sample_entrances
    >>> entrances = sample_entrances(CASES["III"], 0.6, 5000, rng=1)
    >>> outcomes = classify_orbits(CASES["III"], 0.6, entrances, t_max=1e4)
    >>> times = np.fmin(outcomes.escape_time, outcomes.t_max)  # t_max where an orbit stays
    >>> round(float(times.mean()), 1), round(compute_flux(CASES["III"], 0.6).mean_passage_time, 1)
    (4.0, 4.0)
    """
    return sample_entrances_by_exit(potential, energy, count, rng=rng)[1]


@checks_types(potential=Potential)
def sample_entrances_by_exit(
    potential: Potential, energy: float, count: int, *, rng: RandomNumbers = None
) -> tuple[np.ndarray, np.ndarray]:
    """Draw random states like `sample_entrances`, and return the exit of each.

    Parameters
    ----------
    potential, energy, count, rng
        The potential, h, the number of states and the random numbers, see `sample_entrances`.

    Returns
    -------
    entrances
        (count,) int64, number of the exit through which each orbit enters.
    states
        (count, 4) x, y, px, py of each state, see `sample_entrances`.

    Raises
    ------
    ValueError
        If a parameter is out of range, all exits are closed at this energy, or the frame rotates.

    Examples
    --------
    >>> from escape_explorer import CASES, sample_entrances_by_exit
    >>> entrances, states = sample_entrances_by_exit(CASES["III"], 0.6, 1000)
    >>> sorted(set(entrances.tolist())), states.shape
    ([1, 2, 3, 4], (1000, 4))
    """
    potential.check_at_rest("random entrances")
    h = checked_number("energy", energy)
    count = checked_count("count", count, 1, LARGEST_SAMPLE)
    random = checked_generator(rng)
    orbits = find_lyapunov_orbits(potential, h)
    if not orbits:
        raise ValueError(f"energy={h}: all exits are closed; must be above the escape energy {potential.escape_energy:.6g}")
    lines = [_ExitLine(potential, orbit) for orbit in orbits]
    flux = np.array([line.cumulative_flux[-1] for line in lines])
    line_index = random.choice(len(lines), count, p=flux / flux.sum())
    states = np.empty((count, 4))
    for index, line in enumerate(lines):
        states[line_index == index] = line.draw(int((line_index == index).sum()), random)
    return np.array([orbit.channel for orbit in orbits], np.int64)[line_index], states


class _ExitLine:
    """Draws states that cross an exit line inward, with the distribution of the flux. The line is half a Lyapunov orbit."""

    def __init__(self, potential: Potential, orbit: LyapunovOrbit) -> None:
        # The import is slow and seldom needed.
        from scipy.interpolate import CubicSpline

        self._potential, self._energy = potential, orbit.energy
        path = orbit.half_path
        self._path = CubicSpline(np.linspace(0.0, 0.5 * orbit.period, len(path)), path)
        self.times = np.linspace(0.0, 0.5 * orbit.period, _POINTS)
        speed_squared = (self._path(self.times, 1) ** 2).sum(axis=1)
        increments = 0.5 * (speed_squared[1:] + speed_squared[:-1]) * np.diff(self.times)
        # Flux through the line from its beginning to the point of each time, without constant factors.
        self.cumulative_flux = np.concatenate([[0.0], np.cumsum(increments)])
        self._length = float(np.hypot(*(path[-1] - path[0])))
        self._side = self._find_side()

    def draw(self, count: int, random: np.random.Generator) -> np.ndarray:
        """Draw states, (count, 4), uniform in the flux: in ∫ p·dq along the line, and in the component of p along the line."""
        times = np.interp(random.uniform(0.0, self.cumulative_flux[-1], count), self.cumulative_flux, self.times)
        points, along, left = self._points_and_directions(times)
        inward = self._side * left
        points = points + _SHIFT * self._length * inward
        kinetic = np.maximum(self._energy - self._potential.value(*points.T), 0.0)
        momentum = np.sqrt(2.0 * self._potential.mass * kinetic)
        sine = random.uniform(-1.0, 1.0, count)
        directions = sine[:, None] * along + np.sqrt(1.0 - sine * sine)[:, None] * inward
        return np.column_stack([points, momentum[:, None] * directions])

    def _points_and_directions(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return points of the line, (n, 2), and unit vectors along the line and to its left, (n, 2) each."""
        velocity: Any = self._path(times, 1)
        along = velocity / np.maximum(np.hypot(*velocity.T), np.finfo(float).tiny)[:, None]
        return self._path(times), along, np.column_stack([-along[:, 1], along[:, 0]])

    def _find_side(self) -> float:
        """Return 1 if the well is to the left of the line, otherwise −1."""
        middle, _, left = self._points_and_directions(self.times[[_POINTS // 2]])
        # A point to the left of the middle of the line, so far away that rounding does not decide on which side it is.
        test_point = middle + 1e3 * _SHIFT * self._length * left
        outside = find_outside_channels(self._potential, self._energy, *np.ascontiguousarray(test_point.T))
        return -1.0 if outside[0] else 1.0
