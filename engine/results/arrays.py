"""Read-only arrays, for results that are cached and shared."""

from __future__ import annotations

import numpy as np


def read_only(array: np.ndarray) -> np.ndarray:
    """Mark an array read-only in place and return it; for several arrays, ``map(read_only, arrays)``."""
    array.flags.writeable = False
    return array
