"""Test of the n-fold symmetry of V = r²/2 − rⁿ cos nθ / n: each start of an (x, y) map, and the start rotated by 2π/n.

The rotated orbit escapes through the next channel at the same time, except for rounding errors, which grow along chaotic orbits.

Run: uv run python -m benchmarks.rotations
"""

from __future__ import annotations

import numpy as np

from engine import Fate, MapSpec, Plane, Potential, channel_family, classify_orbits, compute_map

CHANNELS = (5, 8)
ENERGIES = (1.02, 1.2, 1.6)
"""In units of the escape energy."""

SIDE = 150
T_MAX = 1e3
EARLY = 20.0
"""Orbits that escape before this time are hardly affected by rounding errors."""


def rotated(states: np.ndarray, channels: int) -> np.ndarray:
    """(n, 4) states, rotated by 2π / channels."""
    angle = 2.0 * np.pi / channels
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.column_stack([states[:, :2] @ rotation.T, states[:, 2:] @ rotation.T])


def measure(potential: Potential, energy: float) -> str:
    """One row of the table."""
    whole = compute_map(MapSpec(potential, Plane.X_Y, energy, (SIDE, SIDE), t_max=T_MAX))
    rows, columns = np.nonzero(whole.interior)
    states = whole.spec.start_states(whole.x[columns], whole.ordinate[rows])
    fate, time = whole.fate[rows, columns], whole.escape_time[rows, columns]
    others = classify_orbits(potential, energy, rotated(states, potential.channels), T_MAX)
    expected = np.where(fate > Fate.BOUNDED, fate % potential.channels + 1, fate)
    same, early = others.fate == expected, time < EARLY
    shares = [np.mean(fate == channel) for channel in range(1, potential.channels + 1)]
    moved = np.mean([abs(np.mean(others.fate == k % potential.channels + 1) - shares[k - 1]) for k in range(1, len(shares) + 1)])
    apart = np.abs(others.escape_time - time)[early & same].max()
    cells = (
        f"{fate.size}",
        f"{same.mean():.3%}",
        f"{same[early].mean():.3%}",
        f"{early.mean():.1%}",
        f"{apart:.1e}",
        f"{moved:.3%}",
    )
    return f"| {potential.name} | {energy / potential.escape_energy:.2f} | {' | '.join(cells)} |"


def main() -> None:
    print(f"| potential | h / escape energy | starts | equal fates | of these before t = {EARLY:g} | escape before then | "
          "largest difference of their times | mean change of a channel's share |\n|" + "---|" * 8)  # fmt: skip
    for channels in CHANNELS:
        for energy in ENERGIES:
            potential = channel_family(channels)
            print(measure(potential, energy * potential.escape_energy), flush=True)


if __name__ == "__main__":
    main()
