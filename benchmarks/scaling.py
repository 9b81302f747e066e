"""Time of a map against resolution, t_max and cores, and the memory of the largest map.

Run: uv run python -m benchmarks.scaling
"""

from __future__ import annotations

import resource
import statistics
import time
from concurrent.futures import Executor, ThreadPoolExecutor
from functools import cache

from engine import CASES, MapSpec, Plane, compute_map
from engine.execution import default_executor

REPEATS = 3


@cache
def one_core() -> ThreadPoolExecutor:
    """A pool with a single thread."""
    return ThreadPoolExecutor(1)


def seconds(spec: MapSpec, executor: Executor | None = None) -> float:
    """Median time of a map."""
    times = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        compute_map(spec, executor=executor)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    one, three = CASES["I"], CASES["III"]
    print("| map | t_max | resolution | seconds |\n|---|---|---|---|")
    for side in (224, 450, 1000):
        print(f"| I (x, px) 0.25 | 1e5 | {side} | {seconds(MapSpec(one, Plane.X_PX, 0.25, (side, side))):.2f} |", flush=True)
    for t_max in (1e3, 1e4, 1e5, 1e6):
        print(
            f"| III (x, px) 0.35 | {t_max:g} | 224 | {seconds(MapSpec(three, Plane.X_PX, 0.35, t_max=t_max)):.2f} |", flush=True
        )
    print(f"\n| map | one core, s | {default_executor()._max_workers} cores, s | ratio |\n|---|---|---|---|")
    for name, spec in {
        "I (x, px) 0.12, t_max = 2e4, no certificates": MapSpec(one, Plane.X_PX, 0.12, (100, 100), t_max=2e4, certify=False),
        "III (x, px) 0.45, t_max = 1e3": MapSpec(three, Plane.X_PX, 0.45, (450, 450), t_max=1e3),
        "III (x, px) 0.26, t_max = 1e5": MapSpec(three, Plane.X_PX, 0.26),
    }.items():
        alone, together = seconds(spec, one_core()), seconds(spec)
        print(f"| {name} | {alone:.2f} | {together:.2f} | {alone / together:.2f} |", flush=True)
    before = peak_memory()
    begin = time.perf_counter()
    result = compute_map(MapSpec(three, Plane.X_PX, 0.45, (4000, 4000), t_max=1e3))
    elapsed = time.perf_counter() - begin
    print(f"\n4000 x 4000, III (x, px) 0.45, t_max = 1e3: {elapsed:.0f} s; the result takes {result.nbytes / 2**20:.0f} MiB,")
    print(f"the process at most {peak_memory():.0f} MiB, {before:.0f} MiB before")


def peak_memory() -> float:
    """Peak resident memory of this process in MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
