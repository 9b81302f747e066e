"""How long it takes to see why: each second look at one map, warm, as medians over repeats, beside the map itself.

Run: uv run python -m benchmarks.why
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

from engine import (
    CASES,
    ENTROPY_COUNTS_BOUNDED,
    WADA_COUNTS_BOUNDED,
    MapSpec,
    Plane,
    compute_basin_entropy,
    compute_map,
    compute_origin_fates,
    compute_statistics,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    exit_labels,
    find_stable_manifolds,
    fit_decay_laws,
    prepare_kernels,
)
from engine.execution import default_executor

REPEATS = 5
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.45)
IMAGES = 3


def median_seconds(work: Callable[[], Any]) -> float:
    times = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    prepare_kernels(SPEC.potential)
    frame = compute_map(SPEC)
    entropy, merging = (exit_labels(frame.fate, bounded=bounded) for bounded in (ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED))
    counted = compute_statistics(frame)
    works: dict[str, Callable[[], Any]] = {
        "the map itself": lambda: compute_map(SPEC),
        "trust mask": lambda: compute_trust(frame),
        "basin entropy": lambda: compute_basin_entropy(*entropy),
        "Wada merging test": lambda: compute_wada_test(*merging),
        "escape laws with bootstrap": lambda: fit_decay_laws(counted, SPEC.t_max),
        f"stable manifolds, {IMAGES} images, all channels": lambda: find_stable_manifolds(SPEC.potential, 0.45, IMAGES),
        "origin and fate, both maps": lambda: compute_origin_fates(SPEC),
        "uncertainty exponent": lambda: compute_uncertainty_exponent(SPEC),
    }
    threads = default_executor()._max_workers
    print(f"III, (x, px), h = 0.45, 225 x 225, t_max = 1e5, {threads} threads, median of {REPEATS} warm runs\n")
    print("| what | seconds |\n|---|---|")
    for name, work in works.items():
        print(f"| {name} | {median_seconds(work):.3g} |")


if __name__ == "__main__":
    main()
