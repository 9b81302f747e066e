"""What energies may be swept, and on which planes."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.dynamics.planes import Plane
from engine.validation import LARGEST_NUMBER, shown


def checked_sweep(plane: Any, energies: Any, most: int) -> tuple[Plane, tuple[float, ...]]:
    """The plane, and the energies sorted and made unique; ValueError unless they can be swept, at most so many of them."""
    checked_plane = Plane(plane)
    if checked_plane is Plane.X_H:
        raise ValueError(f"plane={checked_plane.value}: energies are swept on (x, y) or (x, px); (x, h) holds all of them")
    try:
        checked = tuple(sorted({float(h) for h in energies}))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"energies={shown(energies)}: must be finite numbers") from None
    if not 1 <= len(checked) <= most or not np.all(np.abs(checked) <= LARGEST_NUMBER):
        raise ValueError(f"energies: {len(checked)} different ones; must be 1 to {most} finite numbers")
    return checked_plane, checked
