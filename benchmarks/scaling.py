"""Time of a map against resolution and t_max, and the memory of the largest map; all maps of the paper against cores.

Run: uv run python -m benchmarks.scaling
     uv run python -m benchmarks.scaling --cores             # the 54 maps on one and on all cores
     uv run python -m benchmarks.scaling --expected 4 16 64  # their expected times on other numbers of cores

The expected time is an upper bound. Each task of a map is timed on one core, with the map divided into tasks as for the other
number of cores. Between two barriers, where no task is left, the tasks take their sum divided by the cores, or as long as the
longest. The time of the calling thread is added, although much of it overlaps with tasks.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from benchmarks.all_maps import specs, title
from engine import CASES, MapSpec, Plane, compute_map
from engine.execution import count_cores

REPEATS, LONG = 5, 3.0


@contextmanager
def one_core() -> Iterator[ThreadPoolExecutor]:
    """A pool with a single thread, on the same core as the calling thread."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        with ThreadPoolExecutor(1) as executor:
            yield executor
    finally:
        os.sched_setaffinity(0, cores)


def seconds(spec: MapSpec, executor: Executor | None = None) -> float:
    """Median time of a map; a single one if it is long."""
    times: list[float] = []
    while len(times) < REPEATS and sum(times) < LONG:
        begin = time.perf_counter()
        compute_map(spec, executor=executor)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


class TimedTasks(Executor):
    """Runs tasks one after the other in a thread of its own, and records their processor times."""

    def __init__(self, workers: int) -> None:
        self._max_workers = workers
        self._thread = ThreadPoolExecutor(1)
        self._left, self._lock = 0, threading.Lock()
        self.between_barriers: list[list[float]] = []

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call."""
        with self._lock:
            if not self._left:
                self.between_barriers.append([])
            self._left += 1
        return self._thread.submit(self._run, self.between_barriers[-1], fn, *args, **kwargs)

    def _run(self, times: list[float], fn: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        begin = time.thread_time()
        try:
            return fn(*args, **kwargs)
        finally:
            times.append(time.thread_time() - begin)
            with self._lock:
                self._left -= 1


def expected_times(spec: MapSpec, cores: int) -> tuple[float, float, float]:
    """Seconds of the calling thread, those of all tasks, and the expected time on a number of cores."""
    executor = TimedTasks(cores)
    begin = time.thread_time()
    compute_map(spec, executor=executor)
    serial = time.thread_time() - begin
    tasks = sum(map(sum, executor.between_barriers))
    return serial, tasks, serial + sum(max(sum(times) / cores, max(times)) for times in executor.between_barriers)


def compare_cores() -> None:
    """Print the time of each map of the paper on one core and on all."""
    cores, ratios = count_cores(), []
    print(f"| case | plane | h | one core, s | {cores} cores, s | ratio |\n|---|---|---|---|---|---|")
    for spec in specs(224):
        compute_map(replace(spec, resolution=(20, 20)))
        with one_core() as executor:
            alone = seconds(spec, executor)
        together = seconds(spec)
        ratios.append(alone / together)
        print(f"| {title(spec)} | {alone:.3f} | {together:.3f} | {ratios[-1]:.2f} |", flush=True)
    print(f"\nGeometric mean {statistics.geometric_mean(ratios):.2f}, smallest {min(ratios):.2f}")


def expect_times(core_counts: list[int]) -> None:
    """Print the expected time of each map of the paper on several numbers of cores."""
    columns = " | ".join(f"{cores} cores, s" for cores in core_counts)
    print(f"| case | plane | h | serial share | tasks, s | {columns} |\n|{'---|' * (5 + len(core_counts))}")
    for spec in specs(224):
        compute_map(replace(spec, resolution=(20, 20)))
        rows = [expected_times(spec, cores) for cores in core_counts]
        serial, tasks, _ = rows[0]
        expected = " | ".join(f"{row[2]:.3f}" for row in rows)
        print(f"| {title(spec)} | {serial / (serial + tasks):.1%} | {tasks:.2f} | {expected} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--cores", action="store_true")
    parser.add_argument("--expected", nargs="+", type=int, metavar="CORES")
    arguments = parser.parse_args()
    if arguments.cores:
        compare_cores()
    elif arguments.expected:
        expect_times(arguments.expected)
    else:
        scale_maps()


def scale_maps() -> None:
    """Print the times of maps against resolution and t_max, and the memory of the largest map."""
    one, three = CASES["I"], CASES["III"]
    print("| map | t_max | resolution | seconds |\n|---|---|---|---|")
    for side in (224, 450, 1000):
        print(f"| I (x, px) 0.25 | 1e5 | {side} | {seconds(MapSpec(one, Plane.X_PX, 0.25, (side, side))):.2f} |", flush=True)
    for t_max in (1e3, 1e4, 1e5, 1e6):
        print(
            f"| III (x, px) 0.35 | {t_max:g} | 224 | {seconds(MapSpec(three, Plane.X_PX, 0.35, t_max=t_max)):.2f} |", flush=True
        )
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
