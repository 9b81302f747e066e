"""Validation of the plane and the energies, or values of a parameter, of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.slices.planes import checked_slice
from engine.slices.slice import Slice
from engine.validation import LARGEST_NUMBER, short_repr


def checked_sweep(plane: Any, values: Any, most: int, name: str = "energies") -> tuple[Slice, tuple[float, ...]]:
    """The plane, and the values sorted and made unique.

    Parameters
    ----------
    plane
        A slice without an axis h, such as (x, y) or (x, px).
    values
        Finite numbers, 1 to `most` different ones.
    most
        Largest number of values.
    name
        Name of the values in errors.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """
    checked_plane = checked_slice(plane)
    if checked_plane.energy_axis is not None:
        raise ValueError(f"plane={checked_plane.title}: must have no axis h, which already contains all energies")
    checked_plane.check_one_potential("plane")
    try:
        checked = tuple(sorted({float(h) for h in values}))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}={short_repr(values)}: must be a sequence of finite numbers") from None
    if not 1 <= len(checked) <= most or not np.all(np.abs(checked) <= LARGEST_NUMBER):
        raise ValueError(f"{name}: {len(checked)} different ones; must be 1 to {most} finite numbers")
    return checked_plane, checked
