"""The energies at which Zotos (2014) draws its maps, and the ranges it scans: what the slider marks and spans."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class EnergyRange:
    """The slider's ends, the (x, h) plane's range, the energies to mark, such as the nine of the paper, and where to begin."""

    low: float
    high: float
    marked: tuple[float, ...]
    first: float
    decimals: int = 3
    """Of the energies that the slider stops at."""


ENERGIES = {
    "I": EnergyRange(0.1, 0.5, (0.13, 0.15, 0.17, 0.19, 0.21, 0.23, 0.25, 0.27, 0.30), 0.19),
    "II": EnergyRange(0.14, 0.5, (0.17, 0.18, 0.19, 0.20, 0.22, 0.24, 0.26, 0.28, 0.30), 0.20),
    "III": EnergyRange(0.2, 1.0, (0.26, 0.28, 0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60), 0.35),
}
