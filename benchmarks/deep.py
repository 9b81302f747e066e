"""Cost of double-double arithmetic: the same maps by `compute_map` and by `compute_deep_map`.

Windows of width 0.5, in which both find the fates; processor time, kernels warm, without certificates.

Run: uv run python -m benchmarks.deep [pixels per side, 64]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from engine import CASES, MapSpec, Plane, compute_deep_map, compute_map

ENERGIES = {"I": 0.25, "II": 0.25, "III": 0.45}
CENTRE, WIDTH, T_MAX, RUNS = ("0.1", "0.2"), 0.5, 300.0, 3


def timed(compute: Callable[[], Any]) -> tuple[Any, float]:
    """The result, and the least processor time in seconds."""
    seconds = []
    for _ in range(RUNS):
        begin = time.process_time()
        result = compute()
        seconds.append(time.process_time() - begin)
    return result, min(seconds)


def row(case: str, side: int) -> str:
    """One line of the table."""
    x, y = map(float, CENTRE)
    window = (x - WIDTH / 2, x + WIDTH / 2, y - WIDTH / 2, y + WIDTH / 2)
    spec = MapSpec(CASES[case], Plane.X_PX, ENERGIES[case], (side, side), t_max=T_MAX, certify=False)
    windowed = MapSpec(CASES[case], Plane.X_PX, ENERGIES[case], (side, side), window, T_MAX, certify=False)
    compute_map(windowed)
    compute_deep_map(spec, CENTRE, WIDTH)
    plain, seconds = timed(lambda: compute_map(windowed))
    deep, deep_seconds = timed(lambda: compute_deep_map(spec, CENTRE, WIDTH))
    differing = int(np.sum(plain.fate != deep.fate))
    ratio = f"{seconds:.3f} | {deep_seconds:.2f} | {deep_seconds / seconds:.0f}"
    return f"| {case} | {ENERGIES[case]} | {ratio} | {np.nanmax(deep.energy_error):.1e} | {differing} |"


def main() -> None:
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 64
    print(f"{side} × {side}\n")
    print(
        "| case | h | doubles, s | double-double, s | ratio | worst energy error | other fates |\n|---|---|---|---|---|---|---|"
    )
    for case in CASES:
        print(row(case, side), flush=True)


if __name__ == "__main__":
    main()
