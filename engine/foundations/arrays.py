"""Read-only arrays, because results are cached and shared."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def read_only(array: np.ndarray) -> np.ndarray:
    """Mark an array read-only in place, and return it."""
    array.flags.writeable = False
    return array


class ReadOnlyArrays:
    """Base of dataclasses that make their arrays read-only, also after unpickling, because NumPy does not pickle the flag."""

    def __post_init__(self) -> None:
        self.__setstate__(vars(self))

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        vars(self).update({name: read_only(value) if isinstance(value, np.ndarray) else value for name, value in state.items()})
