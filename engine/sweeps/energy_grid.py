"""Validation of the plane and the energies of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.slices.slice import Slice, checked_slice
from engine.validation import LARGEST_NUMBER, short_repr


def checked_sweep(plane: Any, energies: Any, most: int) -> tuple[Slice, tuple[float, ...]]:
    """The plane, and the energies sorted and made unique.

    Parameters
    ----------
    plane
        A slice without an axis h, such as (x, y) or (x, px).
    energies
        Finite numbers, 1 to `most` different ones.
    most
        Largest number of energies.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """
    checked_plane = checked_slice(plane)
    if checked_plane.energy_axis is not None:
        raise ValueError(f"plane={checked_plane.title}: must have no axis h, which already contains all energies")
    try:
        checked = tuple(sorted({float(h) for h in energies}))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"energies={short_repr(energies)}: must be finite numbers") from None
    if not 1 <= len(checked) <= most or not np.all(np.abs(checked) <= LARGEST_NUMBER):
        raise ValueError(f"energies: {len(checked)} different ones; must be 1 to {most} finite numbers")
    return checked_plane, checked
