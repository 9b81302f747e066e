"""What the searches for critical points have in common: an empty list, and the reasons for which they fail."""

from __future__ import annotations

import numpy as np

from engine.foundations.arrays import read_only

NO_POINTS = read_only(np.empty((0, 2)))
"""(0, 2) an empty list of points."""


class NotIsolatedError(ValueError):
    """The critical points form a curve, so they cannot be listed."""

    def __init__(self, message: str = "the force vanishes along a curve instead of at isolated points") -> None:
        super().__init__(message)


class UndecidedError(ValueError):
    """The points are not found within the limit on the work."""


class DescentError(ValueError):
    """A line of steepest descent whose end is not found."""
