"""Energies of the maps in Zotos (2014), and the energy ranges of the slider."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class EnergyRange:
    """Energies of a system.

    Attributes
    ----------
    low, high
        Ends of the slider; `high` is also the upper end of the (x, h) plane.
    marked
        Energies marked on the slider, such as the nine of the paper.
    first
        Initial energy.
    decimals
        Decimals of the energies on the slider.
    """

    low: float
    high: float
    marked: tuple[float, ...]
    first: float
    decimals: int = 3


ENERGIES = {
    "I": EnergyRange(0.1, 0.5, (0.13, 0.15, 0.17, 0.19, 0.21, 0.23, 0.25, 0.27, 0.30), 0.19),
    "II": EnergyRange(0.14, 0.5, (0.17, 0.18, 0.19, 0.20, 0.22, 0.24, 0.26, 0.28, 0.30), 0.20),
    "III": EnergyRange(0.2, 1.0, (0.26, 0.28, 0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60), 0.35),
}
"""Energy ranges of the cases of Zotos (2014)."""
