"""Make equations of motion for SciPy's DOP853. From the engine, they use only the terms and the Hessian of the potential."""

from __future__ import annotations

import numpy as np

from engine import Potential


def force(potential: Potential, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    fx = sum(-c * i * x ** (i - 1) * y**j for i, j, c in potential.terms if i)
    fy = sum(-c * j * x**i * y ** (j - 1) for i, j, c in potential.terms if j)
    return fx, fy


def equations(potential: Potential):
    def derivative(_t: float, flat: np.ndarray) -> np.ndarray:
        x, y, px, py = flat.reshape(4, -1)
        return np.concatenate([px, py, *force(potential, x, y)])

    return derivative


def variational_equations(potential: Potential):
    """Return the equations of 12 variables: x, y, px, py of an orbit, and δx, δy, δpx, δpy of two deviation vectors."""

    def derivative(_t: float, flat: np.ndarray) -> np.ndarray:
        x, y, px, py = flat[:4]
        out = [px, py, *force(potential, x, y)]
        vxx, vxy, vyy = potential.hessian(x, y)
        for dx, dy, dpx, dpy in flat[4:].reshape(2, 4):
            out += [dpx, dpy, -vxx * dx - vxy * dy, -vxy * dx - vyy * dy]
        return np.array(out)

    return derivative
