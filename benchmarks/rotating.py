"""Integration speed on one thread beside heyoka's batch mode in rotating frames: the same bounded orbits to the same time.

As `benchmarks.throughput`, with case III for comparison, but in seconds of the processor, so that other programs disturb less.
heyoka has the tolerance with which it is fastest among those that keep its error within twice the error here, or within 1e-11.

Run: uv run python -m benchmarks.rotating
"""

from __future__ import annotations

import itertools
import time
from typing import NamedTuple

import heyoka as hy
import numpy as np

from engine import POTENTIALS, Potential, classify_orbits, sample_starts
from engine.exits.exit_rows import closed_exits, exit_gates
from engine.integrator.kernels import propagate
from engine.integrator.kernels.events import NOT_COMPUTED
from engine.integrator.source.recurrence import TOLERANCE
from engine.systems.compiled import kernels_of
from tests.peers.taylor_heyoka import equations

SYSTEMS = (("III", 0.24), ("Copenhagen", -2.2), ("Barred galaxy", -3300.0))
ORBITS, REPEATS = 64, 3
# In exact units of time.
DURATION, KEPT_APART = 1e4, 20.0
# Largest error of heyoka, as a multiple of the error here and as a number.
EQUAL, SMALL = 2.0, 1e-11
TOLERANCES = (2.2e-16, 3e-15, 3e-14, 1e-13, 4e-13, 7e-13)
BATCH = hy.recommended_simd_size()


class Run(NamedTuple):
    """Exact units of time per second, worst relative energy error, steps per second."""

    rate: float
    error: float
    steps: float


def bounded_starts(potential: Potential, energy: float) -> np.ndarray:
    """(ORBITS, 4) starts that do not end, in units of the well; around a body further away than 20 radii of its disc."""
    wide = [type(c)(c.x, c.y, KEPT_APART * c.radius, c.name) for c in potential.centres]
    kept_apart, t_max = potential.with_outcomes(wide, potential.escape_radius), DURATION * potential.well.exact_time_unit
    found = np.empty((0, 4))
    for seed in itertools.count():
        starts = sample_starts(potential, energy, 20 * ORBITS, seed=seed)
        found = np.vstack([found, starts[classify_orbits(kept_apart, energy, starts, t_max).fate == 0]])
        if len(found) >= ORBITS:
            return np.ascontiguousarray(found[:ORBITS] / potential.units.state)
    raise AssertionError


def by_engine(potential: Potential, energy: float, states: np.ndarray, duration: float) -> Run:
    """With refill, and tests of exits and crossings."""
    curves, n = closed_exits(potential)[None], len(states)
    counts, fates, pending = np.zeros((3, n), np.int64), np.full(n, NOT_COMPUTED, np.int8), np.ones(n, np.uint8)
    exits = propagate.Exits(exit_gates(curves), curves, counts[0])
    orbits = propagate.Orbits(states.copy(), np.zeros(n), counts[1], counts[2], fates, pending, np.zeros((n, 2)))
    begin = time.process_time()
    steps = kernels_of(potential).propagate(np.arange(n), duration, True, TOLERANCE, 2**62, 0, exits, orbits, propagate.NO_TRACE)
    seconds = time.process_time() - begin
    error = np.max(np.abs(potential.energy(orbits.state) / energy - 1.0))
    return Run(orbits.t.sum() / seconds, float(error), steps / seconds)


def by_heyoka(potential: Potential, energy: float, states: np.ndarray, duration: float, tolerance: float) -> Run:
    """Without events."""
    integrator = hy.taylor_adaptive_batch(equations(potential), np.zeros((4, BATCH)), tol=tolerance)
    seconds = error = steps = 0.0
    for begin in range(0, len(states) // BATCH * BATCH, BATCH):
        integrator.set_time([0.0] * BATCH)
        integrator.state[:] = states[begin : begin + BATCH].T
        started = time.process_time()
        integrator.propagate_until(np.full(BATCH, duration))
        seconds += time.process_time() - started
        steps += sum(result[3] for result in integrator.propagate_res)
        error = max(error, float(np.max(np.abs(potential.energy(integrator.state.T) / energy - 1.0))))
    return Run(len(states) // BATCH * BATCH * duration / seconds, error, steps / seconds)


def main() -> None:
    print("| system | h | this engine: steps/s | time units/s | worst error | error permitted to heyoka ", end="")
    print("| heyoka: steps/s | time units/s | tolerance | worst error | ratio of steps/s | of time units/s |")
    print(f"|{'---|' * 12}", flush=True)
    for name, energy in SYSTEMS:
        potential = POTENTIALS[name]
        well, level = potential.in_well_units, energy / potential.units.energy
        states, duration = bounded_starts(potential, energy), DURATION * potential.well.exact_time_unit / potential.units.time
        by_engine(well, level, states, 10.0)
        pairs: dict[str, list[tuple[Run, Run, float]]] = {"equal": [], f"{SMALL:g}": []}
        for _ in range(REPEATS):
            engine = by_engine(well, level, states, duration)
            peers = [(by_heyoka(well, level, states, duration, tolerance), tolerance) for tolerance in TOLERANCES]
            for found, limit in zip(pairs.values(), (EQUAL * engine.error, max(SMALL, engine.error)), strict=True):
                permitted = [peer for peer in peers if peer[0].error <= limit]
                found.append((engine, *max(permitted or peers[:1])))
        for limit_name, found in pairs.items():
            engine, heyoka, tolerance = sorted(found, key=lambda pair: pair[0].rate / pair[1].rate)[REPEATS // 2]
            print(f"| {name} | {energy} | {engine.steps:.3g} | {engine.rate:.3g} | {engine.error:.1e} | {limit_name} ", end="")
            print(f"| {heyoka.steps:.3g} | {heyoka.rate:.3g} | {tolerance:g} | {heyoka.error:.1e} ", end="")
            print(f"| {engine.steps / heyoka.steps:.2f} | {engine.rate / heyoka.rate:.2f} |", flush=True)


if __name__ == "__main__":
    main()
