"""The energy of a map: one number, or its range along an axis h."""

from __future__ import annotations

Energy = float | tuple[float, float]
"""The energy of a map: h, or on a slice with an axis h its range (low, high)."""


def common_energy(energy: Energy) -> float | None:
    """h of all starts of a map; None on a slice with an axis h."""
    return None if isinstance(energy, tuple) else energy


def highest_energy(energy: Energy) -> float:
    """The highest h of a map."""
    return energy[1] if isinstance(energy, tuple) else energy


def scaled_energy(energy: Energy, factor: float) -> Energy:
    """The energy of a map in other units."""
    return (factor * energy[0], factor * energy[1]) if isinstance(energy, tuple) else factor * energy
