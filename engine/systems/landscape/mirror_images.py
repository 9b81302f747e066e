"""Mirror images of points under x → −x, y → −y and both, the symmetries of functions V that are even in x or in y."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from engine.systems.forms.expression_form import Form

Signs = tuple[float, float]
"""The factors of x and y in a reflection."""

IDENTITY: Signs = (1.0, 1.0)
"""No reflection."""

MIRROR_X: Signs = (-1.0, 1.0)
"""The reflection x → −x."""

MIRROR_Y: Signs = (1.0, -1.0)
"""The reflection y → −y."""

MIRROR_BOTH: Signs = (-1.0, -1.0)
"""Both reflections, which are a rotation by 180°."""

ROUNDING = 1e-13
"""Coordinates of a point or a direction below this share of its distance from the origin are rounding errors of zero."""


def mirrors_of(form: Form) -> tuple[Signs, ...]:
    """Return the reflections that leave V unchanged; also their product, a rotation by 180°, if there are two."""
    mirrors = (MIRROR_X,) * form.mirror_in_x + (MIRROR_Y,) * form.mirror_in_y
    return (*mirrors, MIRROR_BOTH) if len(mirrors) == 2 else mirrors


def without_rounding(points: np.ndarray) -> np.ndarray:
    """Return points (n, 2) with exact zeros in place of rounding errors of zero."""
    return np.where(np.abs(points) < ROUNDING * np.hypot(*points.T)[:, None], 0.0, points)


def find_images(points: np.ndarray, signs: Signs) -> np.ndarray:
    """Return the index of the mirror image of each point (n, 2): the nearest of the points, of shape (n,)."""
    distances = np.hypot(*np.moveaxis(points[:, None] - points * signs, -1, 0))
    return np.argmin(distances, axis=0) if len(points) else np.zeros(0, int)


def make_symmetric(points: np.ndarray, vectors: np.ndarray, mirrors: Sequence[Signs]) -> np.ndarray:
    """Return vectors (n, 2) at points (n, 2) such that vectors at mirror images are exact mirror images.

    Those at x < 0 are copied from those at x > 0, and those at y < 0 from those at y > 0.
    """
    symmetric = vectors.copy()
    for axis, signs in enumerate((MIRROR_X, MIRROR_Y)):
        if signs in mirrors:
            images = find_images(points, signs)
            for k in np.flatnonzero(points[:, axis] < 0.0):
                symmetric[k] = symmetric[images[k]] * signs
    return symmetric
