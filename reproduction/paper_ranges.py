"""The energies of each case at which the paper's curves and pictures are remade."""

from __future__ import annotations

import numpy as np

from app.state.energy_ranges import ENERGIES
from engine import CASES, PAPER_FITS

CHANNEL_ENERGIES = {"I": 0.15, "II": 0.2, "III": 0.3}
"""h of the open zero-velocity curve and of one orbit through each channel."""

STICKY_CASE, STICKY_ENERGY = "III", 0.26
"""Where the paper tells regular from chaotic orbits, on (x, px), and finds super-sticky ones."""

# Two ways to the same energy differ by rounding; a map is found again by its energy to the bit.
_DECIMALS = 6


def nine_energies(case: str) -> tuple[float, ...]:
    """Those of the paper's maps."""
    return ENERGIES[case].marked


def three_energies(case: str) -> tuple[float, ...]:
    """The first, the middle and the last of the nine: long-lived, between and short-lived."""
    return nine_energies(case)[::4]


def curve_energies(case: str, count: int) -> tuple[float, ...]:
    """So many, evenly from the paper's lowest map to where it ends its curves."""
    energies = np.linspace(nine_energies(case)[0], PAPER_FITS[case].highest_energy, count)
    return tuple(energies.round(_DECIMALS).tolist())


def plane_energies(case: str) -> tuple[float, float]:
    """Lowest and highest h of the (x, h) plane: from the escape energy on."""
    return CASES[case].escape_energy, ENERGIES[case].high
