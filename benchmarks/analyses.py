"""Time of each follow-up analysis of one map, with warm kernels: medians.

Run: uv run python -m benchmarks.analyses
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

from engine import (
    CASES,
    MapSpec,
    Plane,
    compute_basin_entropy,
    compute_map,
    compute_origin_fates,
    compute_statistics,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_stable_manifolds,
    fit_decay_laws,
)
from engine.execution import DEFAULT_EXECUTION
from engine.measures.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.warmup import prepare_kernels

REPEATS = 5
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.45)
IMAGES = 3


def median_seconds(function: Callable[[], Any]) -> float:
    times = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        function()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    prepare_kernels(SPEC.potential)
    frame = compute_map(SPEC)
    entropy_labels, wada_labels = (
        exit_labels(frame.fate, bounded=bounded) for bounded in (ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED)
    )
    statistics_of_map = compute_statistics(frame)
    analyses: dict[str, Callable[[], Any]] = {
        "map": lambda: compute_map(SPEC),
        "trust": lambda: compute_trust(frame),
        "basin entropy": lambda: compute_basin_entropy(*entropy_labels),
        "Wada test": lambda: compute_wada_test(*wada_labels),
        "decay laws with bootstrap": lambda: fit_decay_laws(statistics_of_map, SPEC.t_max),
        f"stable manifolds, {IMAGES} images, all channels": lambda: find_stable_manifolds(SPEC.potential, 0.45, images=IMAGES),
        "origins and fates, two maps": lambda: compute_origin_fates(SPEC),
        "uncertainty exponent": lambda: compute_uncertainty_exponent(SPEC),
    }
    threads = DEFAULT_EXECUTION.workers
    print(f"III, (x, px), h = 0.45, 224 x 224, t_max = 1e5, {threads} threads, median of {REPEATS} warm runs\n")
    print("| analysis | seconds |\n|---|---|")
    for name, function in analyses.items():
        print(f"| {name} | {median_seconds(function):.3g} |")


if __name__ == "__main__":
    main()
