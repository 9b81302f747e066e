"""Describe the exits independently, from the sampled paths of the Lyapunov orbits.

A Lyapunov orbit is at rest at both ends, so its path is an even function of time about each end. A cosine series through evenly
spaced samples is therefore accurate to rounding errors. In axes along and across the chord between the ends, the path is a graph.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from engine import LyapunovOrbit, Potential, find_lyapunov_orbits

_POINTS = 20001


@dataclass(frozen=True)
class ExitLine:
    """One exit: its channel, the middle of the chord, the outward unit normal of the chord, and the graph u(q)."""

    channel: int
    middle: np.ndarray
    outward: np.ndarray
    q: np.ndarray
    u: np.ndarray

    def in_chord_axes(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        dx, dy = x - self.middle[0], y - self.middle[1]
        return self.outward[0] * dx + self.outward[1] * dy, self.outward[0] * dy - self.outward[1] * dx

    def beyond(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the distance beyond the exit along the normal of the chord; −1 for points beside the exit."""
        u, q = self.in_chord_axes(x, y)
        return np.where(np.abs(q) <= self.q[-1], u - np.interp(q, self.q, self.u), -1.0)

    def past(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the distance beyond the exit or its straight extension, which no interior of the paper's cases crosses."""
        u, q = self.in_chord_axes(x, y)
        return u - np.interp(q, self.q, self.u)


def exit_line(orbit: LyapunovOrbit) -> ExitLine:
    half = np.array([orbit.x, orbit.y])[:, : orbit.x.size // 2 + 1]
    coefficients = fft.dct(half, type=1, axis=1) / (half.shape[1] - 1)
    coefficients[:, [0, -1]] *= 0.5
    tau = np.linspace(0.0, np.pi, _POINTS)
    x, y = sum(c[:, None] * np.cos(k * tau) for k, c in enumerate(coefficients.T))
    middle = np.array([x[0] + x[-1], y[0] + y[-1]]) / 2
    across = np.array([x[-1] - x[0], y[-1] - y[0]])
    across /= np.hypot(*across)
    outward = np.array([across[1], -across[0]])
    # The normal points away from the well, which is at the origin.
    outward = outward if outward @ middle > 0 else -outward
    line = ExitLine(orbit.channel, middle, outward, np.empty(0), np.empty(0))
    u, q = line.in_chord_axes(x, y)
    order = slice(None) if q[-1] > q[0] else slice(None, None, -1)
    assert np.all(np.diff(q[order]) > 0)
    return ExitLine(orbit.channel, middle, outward, q[order], u[order])


def exit_lines(potential: Potential, energy: float) -> list[ExitLine]:
    return [exit_line(orbit) for orbit in find_lyapunov_orbits(potential, energy)]
