"""The monodromy matrix of a closed orbit, with the directions in which nearby orbits approach it and leave it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.foundations.arrays import ReadOnlyArrays, read_only

SYMPLECTIC = read_only(np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(2)))
"""The matrix J of Hamilton's equations ż = J ∇H, with z = (x, y, Px, Py), of shape (4, 4)."""


@dataclass(frozen=True, eq=False)
class Monodromy(ReadOnlyArrays):
    """The linear motion near a closed orbit over one period, in canonical coordinates z = (x, y, Px, Py); arrays are read-only.

    In a frame that rotates at the rate Ω, with a mass m, the canonical momenta are Px = px − m Ω y and Py = py + m Ω x; at rest
    they are px and py. A deviation δz from the start of the orbit becomes M δz after one period.

    Attributes
    ----------
    matrix
        (4, 4) M, dimensionless. It is symplectic: Mᵀ J M = J, and its determinant is 1.
    multipliers
        (2,) complex Floquet multipliers λ and 1/λ, abs(λ) ≥ 1, as `LyapunovOrbit.multipliers`. The other two eigenvalues are 1.
    vectors
        (4, 2) complex, in the columns the eigenvectors of λ and of 1/λ, of length 1. For an unstable orbit they are real: the
        directions at the start along which nearby orbits leave, and approach. They are not unique if λ is 1.
    flow
        (4,) ż at the start, an eigenvector of the multiplier 1.
    """

    matrix: np.ndarray
    multipliers: np.ndarray
    vectors: np.ndarray
    flow: np.ndarray


def canonical_axes(turning: float) -> np.ndarray:
    """Return the matrix, (4, 4), from x, y, px, py to canonical coordinates.

    Parameters
    ----------
    turning
        m Ω, with the mass m and the rate Ω of the frame.
    """
    axes = np.eye(4)
    axes[2, 1], axes[3, 0] = -turning, turning
    return axes


def eigenvectors(matrix: np.ndarray, multipliers: np.ndarray) -> np.ndarray:
    """Return the eigenvectors, (4, 2), of a symplectic matrix, (4, 4), for λ and 1/λ.

    1/λ is an eigenvalue of M where λ is one of M⁻¹ = −J Mᵀ J. This inverse is exact, whereas a small eigenvalue of M has the
    rounding errors of its largest elements.
    """
    inverse = -SYMPLECTIC @ matrix.T @ SYMPLECTIC
    return np.column_stack([_eigenvector(each, multipliers[0]) for each in (matrix, inverse)])


def _eigenvector(matrix: np.ndarray, value: complex) -> np.ndarray:
    """Return the eigenvector, (4,), of the eigenvalue that is nearest to a value."""
    values, vectors = np.linalg.eig(matrix)
    return vectors[:, np.argmin(np.abs(values - value))].astype(complex)
