"""Rotating systems for tests: Hill's problem and the circular restricted three-body problem around its smaller body."""

from __future__ import annotations

from functools import cache

import heyoka as hy
import numpy as np

from engine import POTENTIALS, Potential, System

EARTH_MOON = 1.215058560962404e-2
"""Mass ratio of the catalogue of periodic orbits of the Jet Propulsion Laboratory."""


def hill() -> Potential:
    """Return Φ = −1/r − 3x²/2, Ω = 1: the entry of the catalogue, whose compiled kernels other tests also use."""
    return POTENTIALS["Hill"]


def three_body(mu: float) -> Potential:
    """Return the restricted three-body problem of the catalogue: the body of mass μ is at the origin, the other is at x = −1."""
    return System("Earth-Moon", parameters={"m": mu}).potential


def at_jacobi_constant(constant: float, mu: float = EARTH_MOON) -> float:
    """Return the energy of the Jacobi constant C = x² + y² + 2(1 − μ)/r1 + 2μ/r2 − v², with x and y from the centre of mass."""
    return 0.5 * ((1.0 - mu) ** 2 - constant)


def integrate(mu: float | None, start: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return heyoka's states, of shape (n, 4), at increasing times from 0. `mu` None means Hill's problem."""
    integrator = _integrator(mu)
    integrator.time, integrator.state[:] = 0.0, start
    return np.asarray(integrator.propagate_grid(list(times))[-1])


@cache
def _integrator(mu: float | None) -> hy.taylor_adaptive:
    """Return heyoka's integrator of equations of motion that do not come from the engine."""
    x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
    nearby = (1.0 if mu is None else mu) * (x * x + y * y) ** -1.5
    if mu is None:
        force = 3.0 * x - nearby * x, -nearby * y
    else:
        far = (1.0 - mu) * ((x + 1.0) ** 2 + y * y) ** -1.5
        force = x + 1.0 - mu - far * (x + 1.0) - nearby * x, y - far * y - nearby * y
    return hy.taylor_adaptive([(x, vx), (y, vy), (vx, 2.0 * vy + force[0]), (vy, -2.0 * vx + force[1])], [0.1, 0.0, 0.0, 0.0])
