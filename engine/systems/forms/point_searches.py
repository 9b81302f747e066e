"""An empty list of critical points, and the errors of searches for them."""

from __future__ import annotations

import numpy as np

from engine.foundations.arrays import read_only

NO_POINTS = read_only(np.empty((0, 2)))
"""(0, 2) an empty list of points."""


class NotIsolatedError(ValueError):
    """The critical points form a curve, so that they cannot be listed."""

    def __init__(self, message: str = "the force vanishes along a curve instead of at isolated points") -> None:
        super().__init__(message)


class UndecidedError(ValueError):
    """The points were not found within the limit on the work."""


class DescentError(ValueError):
    """The end of a line of steepest descent was not found."""
