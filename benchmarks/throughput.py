"""Integration speed on one core beside heyoka's batch mode: the same orbits to the same time, with an energy error below 1e-11.

The engine runs with refill, exit and crossing tests; heyoka without events, at the fastest tolerance that keeps the error. The
share of peak compares the multiplications of a step with a loop of independent multiply-adds.

Run: uv run python -m benchmarks.throughput
"""

from __future__ import annotations

import statistics
import time

import heyoka as hy
import numba
import numpy as np

from benchmarks.steps import ENERGIES, ORBITS, T_MAX, bounded_starts, measure
from engine import CASES, Potential
from engine.integrator.source.recurrence import TOLERANCE, generate_code
from engine.integrator.source.series import ORDER
from tests.peers.taylor_heyoka import equations

REPEATS = 3
PERMITTED_ERROR = 1e-11
TOLERANCES = (2.2e-16, 1e-14, 1e-13, 2e-13, 4e-13, 7e-13)
BATCH = hy.recommended_simd_size()


def heyoka_units(case: str, tolerance: float) -> tuple[float, float]:
    """Million time units per second, worst relative energy error."""
    potential, states = CASES[case], bounded_starts(case)
    integrator = hy.taylor_adaptive_batch(equations(potential), np.zeros((4, BATCH)), tol=tolerance)
    seconds = worst = 0.0
    for begin in range(0, ORBITS, BATCH):
        integrator.set_time([0.0] * BATCH)
        integrator.state[:] = states[begin : begin + BATCH].T
        started = time.perf_counter()
        integrator.propagate_until(np.full(BATCH, T_MAX))
        seconds += time.perf_counter() - started
        worst = max(worst, np.max(np.abs(potential.energy(integrator.state.T) / ENERGIES[case] - 1)))
    return ORBITS * T_MAX / seconds / 1e6, worst


def fastest_heyoka(case: str) -> tuple[float, float, float]:
    """(million time units a second, worst energy error, tolerance) of the fastest tolerance with a permitted error."""
    trials = [(*heyoka_units(case, tolerance), tolerance) for tolerance in TOLERANCES]
    return max(trial for trial in trials if trial[1] <= PERMITTED_ERROR)


def multiplications(potential: Potential) -> int:
    """Number of multiplications in one step."""
    step = generate_code(potential.terms, potential.channels).functions[0].program
    return sum(symbol == "*" for symbol, _ in step.operations)


@numba.njit(fastmath={"contract"})
def chains(repeats, a):
    """Eight dependent multiply-adds per number; the numbers are independent, which hides the latency."""
    for _ in range(repeats):
        for i in range(a.shape[0]):
            v = a[i]
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            v = v * 0.9 + 0.1
            a[i] = v


def peak_rate() -> float:
    """Multiply-adds per second on one core, in units of 1e9."""
    a, repeats = np.ones(256), 1_000_000
    chains(1, a)
    begin = time.perf_counter()
    chains(repeats, a)
    return 8 * a.size * repeats / (time.perf_counter() - begin) / 1e9


def main() -> None:
    print("| case | this engine: million time units/s | worst error | heyoka | tolerance | worst error | ratio ", end="")
    print("| multiplications per step | 10⁹ per second | share of peak |")
    print(f"|{'---|' * 10}")
    for case, potential in CASES.items():
        engine_runs, heyoka_runs, peaks = [], [], []
        count = multiplications(potential)
        for _ in range(REPEATS):
            engine_runs.append(measure(case, ORDER, TOLERANCE))
            heyoka_runs.append(fastest_heyoka(case))
            peaks.append(peak_rate())
        steps, units = (statistics.median(run[n] for run in engine_runs) for n in (0, 1))
        rate = steps * count / 1e3
        heyoka, error, tolerance = sorted(heyoka_runs)[REPEATS // 2]
        print(
            f"| {case} | {units:.1f} | {engine_runs[0][2]:.1e} | {heyoka:.2f} | {tolerance:g} | {error:.1e} "
            f"| {units / heyoka:.2f} | {count} | {rate:.1f} | {rate / statistics.median(peaks):.0%} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
