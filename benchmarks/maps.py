"""Measure the median time of a short map and of its first frame, with warm kernels.

Run: uv run python -m benchmarks.maps
"""

from __future__ import annotations

import statistics
import time

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map
from engine.foundations.execution import DEFAULT_EXECUTION

REPEATS = 7
T_MAX = 1000.0
# Case, plane, and energy or range of energies of each map.
MAPS = (
    ("I", Plane.X_PX, 0.25),
    ("II", Plane.X_PX, 0.25),
    ("III", Plane.X_PX, 0.45),
    ("I", Plane.X_Y, 0.25),
    ("III", Plane.X_Y, 0.45),
    ("III", Plane.X_H, (0.25, 1.0)),
)


def time_map(spec: MapSpec) -> tuple[float, float]:
    """Return seconds to the first frame and to the complete map."""
    frames: list[float] = []

    def record(_frame: EscapeMap) -> None:
        frames.append(time.perf_counter())

    begin = time.perf_counter()
    compute_map(spec, record)
    return frames[0] - begin, time.perf_counter() - begin


def main() -> None:
    print(f"224 x 224, t_max = {T_MAX:g}, {DEFAULT_EXECUTION.workers} threads, median of {REPEATS} warm runs\n")
    print("| case | plane | h | first frame, ms | complete map, ms |\n|---|---|---|---|---|")
    for case, plane, energy in MAPS:
        spec = MapSpec(CASES[case], plane, energy, t_max=T_MAX)
        time_map(spec)
        first, whole = (statistics.median(times) for times in zip(*(time_map(spec) for _ in range(REPEATS)), strict=True))
        print(f"| {case} | {plane.title} | {energy} | {1e3 * first:.0f} | {1e3 * whole:.0f} |")


if __name__ == "__main__":
    main()
