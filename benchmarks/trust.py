"""Trusted pixels against shifted starts: 500 confirmed and 500 like-neighbours pixels of ten maps.

Each pixel is integrated to t_max from four starts, shifted by 1e-12 to 1e-11 of the unit of length in random directions. A pixel
is contradicted if one of them has another fate or, having escaped, another number of crossings.

Run: uv run python -m benchmarks.trust [pixels per side, 224]
"""

from __future__ import annotations

import sys

import numpy as np

from engine import CASES, Certificate, EscapeMap, Fate, MapSpec, Plane, Trust, classify_orbits, compute_map, compute_trust

MAPS = (
    ("III", 0.30, Plane.X_PX), ("III", 0.30, Plane.X_Y), ("III", 0.45, Plane.X_PX), ("III", 0.26, Plane.X_PX),
    ("I", 0.13, Plane.X_PX), ("I", 0.15, Plane.X_PX), ("I", 0.13, Plane.X_Y), ("I", 0.19, Plane.X_PX),
    ("II", 0.20, Plane.X_PX), ("II", 0.17, Plane.X_Y),
)  # fmt: skip
SAMPLE, SHIFTS = 500, 4
SHORTEST, LONGEST = 1e-12, 1e-11


def contradicted(escape_map: EscapeMap, pixels: np.ndarray, random: np.random.Generator) -> int:
    """Number of the pixels (n,) whose outcome is another one for a shifted start."""
    x, ordinate = escape_map.coordinates(pixels)
    fate, crossings = escape_map.fate.ravel()[pixels], escape_map.crossings.ravel()[pixels]
    changed = np.zeros(pixels.size, bool)
    for _ in range(SHIFTS):
        shift, angle = random.uniform(SHORTEST, LONGEST, pixels.size), random.uniform(0.0, 2.0 * np.pi, pixels.size)
        states = escape_map.spec.start_states(x + shift * np.cos(angle), ordinate + shift * np.sin(angle))
        exists = np.isfinite(states).all(axis=1)
        outcomes = classify_orbits(escape_map.spec.potential, escape_map.spec.energy, states[exists], escape_map.spec.t_max)
        other_crossings = (fate[exists] >= 1) & (outcomes.crossings != crossings[exists])
        changed[exists] |= (outcomes.fate != fate[exists]) | other_crossings
    return int(np.count_nonzero(changed))


def row(case: str, energy: float, plane: Plane, side: int) -> str:
    """One line of the table."""
    escape_map = compute_map(MapSpec(CASES[case], plane, energy, (side, side)))
    trust = compute_trust(escape_map)
    uncertified = escape_map.certificate == Certificate.INTEGRATED
    doubtful = np.count_nonzero(uncertified & (trust.trust == Trust.DOUBTFUL))
    random, cells = np.random.default_rng(0), []
    for code in (Trust.CONFIRMED, Trust.LIKE_NEIGHBOURS):
        pixels = random.permutation(np.flatnonzero(trust.trust.ravel() == code))[:SAMPLE]
        bounded = np.count_nonzero(escape_map.fate.ravel()[pixels] == Fate.BOUNDED)
        cells.append(f"{contradicted(escape_map, pixels, random)} of {pixels.size} ({bounded} bounded)")
    shares = f"{100.0 * trust.tested_share:.1f} | {100.0 * trust.doubtful_share:.1f}"
    counts = f"{np.count_nonzero(uncertified)} | {doubtful} | {' | '.join(cells)}"
    return f"| {case}, h = {energy:.2f}, {plane.title} | {shares} | {counts} |"


def main() -> None:
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 224
    print(f"{side} × {side}, t_max = 10⁵\n")
    print("| map | tested, % | doubtful, % | bounded, no certificate | of these doubtful | confirmed, changed | like, changed |")
    print(f"|{'---|' * 7}")
    for case, energy, plane in MAPS:
        print(row(case, energy, plane, side), flush=True)


if __name__ == "__main__":
    main()
