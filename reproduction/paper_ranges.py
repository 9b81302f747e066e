"""The energies of the curves and figures of the paper."""

from __future__ import annotations

import numpy as np

from engine import CASES
from engine.systems.catalogue.published_fits import PAPER_FITS
from engine.systems.catalogue.table import PAPER_ENERGIES

CHANNEL_ENERGIES = {"I": 0.15, "II": 0.2, "III": 0.3}
"""Energies of the figures that show an orbit through each exit."""

STICKY_CASE = "III"
"""Case of the paper's regular, chaotic and super-sticky orbits, on (x, px)."""

STICKY_ENERGY = 0.26
"""Energy of the orbits of `STICKY_CASE`."""

# Number of decimals of energies. Maps are looked up by energy, so equal energies must be identical to the bit.
_DECIMALS = 6


def nine_energies(case: str) -> tuple[float, ...]:
    """Return the energies of the paper's maps."""
    return PAPER_ENERGIES[case].marked


def three_energies(case: str) -> tuple[float, ...]:
    """Return the first, the middle and the last of the nine energies, with long, medium and short escape times."""
    return nine_energies(case)[::4]


def curve_energies(case: str, count: int) -> tuple[float, ...]:
    """Return `count` evenly spaced energies, from the paper's lowest map to the end of its curves."""
    energies = np.linspace(nine_energies(case)[0], PAPER_FITS[case].highest_energy, count)
    return tuple(energies.round(_DECIMALS).tolist())


def plane_energies(case: str) -> tuple[float, float]:
    """Return the lowest and highest h of the (x, h) plane."""
    return CASES[case].escape_energy, PAPER_ENERGIES[case].high
