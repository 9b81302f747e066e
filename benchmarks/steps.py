"""Measure speed and energy error of Taylor orders and tolerances, to choose the fastest with an error below 1e-11 at t = 1e5.

The propagation loop of the engine runs with refill and event tests on one core, on 64 bounded orbits per case.

Run: uv run python -m benchmarks.steps
"""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from engine import CASES, Plane, start_states
from engine.exits.exit_rows import closed_exits
from engine.exits.exit_shapes import exit_gates
from engine.foundations.cache_files import CACHE_VARIABLE
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.kernels import propagate
from engine.integrator.kernels.events import NOT_COMPUTED
from engine.integrator.source import polynomial_recurrence, recurrence
from engine.integrator.source.series import Setting

T_MAX = 1e5
ORBITS = 64
# Energies below the escape energies.
ENERGIES = {"I": 0.12, "II": 0.16, "III": 0.24}
# Orders with their tolerances.
TRIALS = ((17, 1e-15), (18, 1e-15), (18, 3e-15), (19, 1e-15), (19, 3e-15), (19, 1e-14), (20, 3e-15), (22, 1e-14))


def bounded_starts(case: str) -> np.ndarray:
    """Return random starts on (x, px) below the escape energy, of shape (ORBITS, 4)."""
    x, px = np.random.default_rng(1).uniform(-0.7, 0.7, (2, 20 * ORBITS))
    states = start_states(CASES[case], Plane.X_PX, ENERGIES[case], x, px)
    inside = np.isfinite(states).all(axis=1) & (np.abs(x) < 0.5)
    return np.ascontiguousarray(states[inside][:ORBITS])


def measure(case: str, order: int, tolerance: float) -> tuple[float, float, float]:
    """Return million steps per second, million time units per second, and the worst relative energy error.

    The function runs in a new process with its own kernel cache, because the order is compiled into the kernels.
    """
    with tempfile.TemporaryDirectory() as cache, ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
        return process.submit(_measure, case, order, tolerance, cache).result()


def _measure(case: str, order: int, tolerance: float, cache: str) -> tuple[float, float, float]:
    os.environ[CACHE_VARIABLE] = cache
    potential = CASES[case]
    polynomial_recurrence.ORDER = recurrence.ORDER = propagate.ORDER = order
    kernels = load_kernels(potential.terms, Setting(potential.channels))
    curves = closed_exits(potential)[None]
    gates = exit_gates(curves)

    def run(horizon: float) -> tuple[np.ndarray, int, float]:
        state = bounded_starts(case)
        n = len(state)
        counts = np.zeros((3, n), np.int64)
        begin = time.perf_counter()
        orbits = propagate.Orbits(
            state, np.zeros(n), counts[1], counts[2], np.full(n, NOT_COMPUTED, np.int8), np.ones(n, np.uint8), np.zeros((n, 2))
        )
        exits = propagate.Exits(gates, curves, counts[0])
        steps = kernels.propagate(np.arange(n), horizon, True, tolerance, 2**62, 0, exits, orbits, propagate.NO_TRACE)
        return state, steps, time.perf_counter() - begin

    # The first run compiles.
    run(10.0)
    state, steps, seconds = run(T_MAX)
    error = np.max(np.abs(potential.energy(state) / ENERGIES[case] - 1))
    return steps / seconds / 1e6, len(state) * T_MAX / seconds / 1e6, float(error)


def main() -> None:
    print("| case | order | tolerance | million steps/s | million time units/s | worst energy error |\n|---|---|---|---|---|---|")
    for case in CASES:
        for order, tolerance in TRIALS:
            steps, units, error = measure(case, order, tolerance)
            print(f"| {case} | {order} | {tolerance:g} | {steps:.1f} | {units:.1f} | {error:.1e} |", flush=True)


if __name__ == "__main__":
    main()
