"""Compare the integration speed on one core with heyoka's batch mode, on the same bounded orbits of each potential.

The engine runs with refill, exit and crossing tests. heyoka runs without events, in the faster of two batch sizes, with two
tolerances: 1e-13, and the loosest whose energy error is at most 1e-11, or at most the engine's error if that is larger. Times are
the least processor times of runs in turn, so that other programs disturb little. Energy errors are the worst relative errors at
the end. State errors are the median errors after a short time, compared with an integration in extended precision and relative to
the largest coordinate.

Run: uv run python -m benchmarks.throughput [NAME …]
"""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

from engine import POTENTIALS, Potential, classify_orbits, sample_starts
from engine.exits.exit_rows import closed_exits
from engine.exits.exit_shapes import exit_gates
from engine.integrator.kernels import propagate
from engine.integrator.kernels.events import NOT_COMPUTED
from engine.integrator.source.recurrence import TOLERANCE
from tests.peers.taylor_heyoka import equations

# Energies at which many orbits are bounded. Other potentials have the energy `BELOW_ESCAPE` times the escape energy.
ENERGIES = {
    "Copenhagen": -2.2,
    "Earth-Moon": -1.12,
    "Hill": -2.4,
    "Star cluster": -2.2,
    "Barred galaxy": -3300.0,
    "Logarithmic bar": -0.6,
    "Two Yukawa centres": -0.2,
}
BELOW_ESCAPE = 0.96
ORBITS = 64
REPEATS = 3
# Duration of the timed integrations, in exact units of time (see `Well`).
DURATION = 1e4
# Duration before the comparison of states, in exact units of time.
SHORT = 20.0
# Smallest distance of the orbits from a body, in units of the potential.
KEPT_APART = 0.02
# Largest energy error of heyoka with its loosest tolerance.
PERMITTED_ERROR = 1e-11
USUAL_TOLERANCE = 1e-13
# One tolerance for each order of heyoka, 13 to 20 without 19. The order determines the step.
TOLERANCES = (5e-11, 1e-11, 1e-12, 1e-13, 2e-14, 2e-15, 2.2e-16)
WIDE_BATCH = 8


class Run(NamedTuple):
    """States of shape (n, 4) and their times of shape (n,) after an integration, and the processor time in seconds."""

    states: np.ndarray
    times: np.ndarray
    seconds: float


Integrate = Callable[[np.ndarray, float], Run]
"""Integrates states of shape (n, 4) over a duration."""


class Problem(NamedTuple):
    """Potential, energy, starts of shape (n, 4) of bounded orbits, and a long and a short duration, in units of the well."""

    potential: Potential
    energy: float
    starts: np.ndarray
    duration: float
    short: float

    def energy_error(self, states: np.ndarray) -> float:
        """Return the worst relative error of the energies of states."""
        return float(np.max(np.abs(self.potential.energy(states) / self.energy - 1.0)))


def pose(name: str) -> Problem:
    """Return the problem of an entry of the catalogue."""
    potential = POTENTIALS[name]
    energy = ENERGIES[name] if name in ENERGIES else BELOW_ESCAPE * potential.escape_energy
    unit = potential.well.exact_time_unit / potential.units.time
    starts = bounded_starts(potential, energy) / potential.units.state
    return Problem(potential.in_well_units, energy / potential.units.energy, starts, DURATION * unit, SHORT * unit)


def bounded_starts(potential: Potential, energy: float) -> np.ndarray:
    """Return starts of orbits that neither end nor come close to a body, of shape (ORBITS, 4)."""
    wide = [type(c)(c.x, c.y, KEPT_APART, c.name) for c in potential.centres]
    kept_apart, t_max = potential.with_outcomes(wide, potential.escape_radius), DURATION * potential.well.exact_time_unit
    found = np.empty((0, 4))
    for seed in itertools.count():
        starts = sample_starts(potential, energy, 20 * ORBITS, rng=seed)
        found = np.vstack([found, starts[classify_orbits(kept_apart, energy, starts, t_max).fate == 0]])
        if len(found) >= ORBITS:
            return np.ascontiguousarray(found[:ORBITS])
    raise AssertionError


def by_engine(problem: Problem) -> Integrate:
    """Return the integrator of the engine, with refill, exit and crossing tests. It returns the states before the last step."""
    curves, kernels = closed_exits(problem.potential)[None], problem.potential.well.kernels
    gates = exit_gates(curves)

    def integrate(states: np.ndarray, duration: float) -> Run:
        n = len(states)
        counts, fates, pending = np.zeros((3, n), np.int64), np.full(n, NOT_COMPUTED, np.int8), np.ones(n, np.uint8)
        orbits = propagate.Orbits(states.copy(), np.zeros(n), counts[1], counts[2], fates, pending, np.zeros((n, 2)))
        exits = propagate.Exits(gates, curves, counts[0])
        begin = time.process_time()
        kernels.propagate(np.arange(n), duration, True, TOLERANCE, 2**62, 0, exits, orbits, propagate.NO_TRACE)
        return Run(orbits.state, orbits.t, time.process_time() - begin)

    return integrate


def by_heyoka(problem: Problem, tolerance: float, batch: int) -> Integrate:
    """Return heyoka's integrator in batch mode, without events."""
    integrator = hy.taylor_adaptive_batch(equations(problem.potential), np.zeros((4, batch)), tol=tolerance, force_avx512=True)

    def integrate(states: np.ndarray, duration: float) -> Run:
        after, seconds = np.empty_like(states), 0.0
        for begin in range(0, len(states), batch):
            integrator.set_time([0.0] * batch)
            integrator.state[:] = states[begin : begin + batch].T
            started = time.process_time()
            integrator.propagate_until(np.full(batch, duration))
            seconds += time.process_time() - started
            after[begin : begin + batch] = integrator.state.T
        return Run(after, np.full(len(states), duration), seconds)

    return integrate


def state_error(problem: Problem, integrate: Integrate) -> float:
    """Return the median error of states after the short time, relative to their largest coordinate."""
    run, errors = integrate(problem.starts, problem.short), []
    integrator = hy.taylor_adaptive(equations(problem.potential), np.zeros(4, np.longdouble), fp_type=np.longdouble)
    for start, state, t in zip(problem.starts, run.states, run.times, strict=True):
        integrator.time = np.longdouble(0.0)
        integrator.state[:] = start
        integrator.propagate_until(np.longdouble(t))
        errors.append(np.max(np.abs(state - integrator.state)) / np.max(np.abs(integrator.state)))
    return float(np.median(errors))


def fastest_batch(problem: Problem) -> int:
    """Return the batch size with which heyoka is faster."""
    runs = {n: by_heyoka(problem, USUAL_TOLERANCE, n) for n in (hy.recommended_simd_size(), WIDE_BATCH)}
    return min(runs, key=lambda n: runs[n](problem.starts, problem.duration / 10.0).seconds)


def loosest(problem: Problem, batch: int, permitted: float) -> tuple[float, Integrate]:
    """Return the loosest tolerance of heyoka whose energy error is permitted, or else the tightest, and its integrator."""
    for tolerance in TOLERANCES:
        integrate = by_heyoka(problem, tolerance, batch)
        if problem.energy_error(integrate(problem.starts, problem.duration).states) <= permitted:
            break
    return tolerance, integrate


def main() -> None:
    print(
        "| potential | time units/s | energy error | state error | ratio | heyoka: tolerance | energy error | state error ",
        end="",
    )
    print("| ratio at 1e-13 | energy error | state error |")
    print(f"|{'---|' * 11}", flush=True)
    for name in sys.argv[1:] or POTENTIALS:
        problem = pose(name)
        engine, batch = by_engine(problem), fastest_batch(problem)
        engine(problem.starts, problem.short)
        own_error = problem.energy_error(engine(problem.starts, problem.duration).states)
        tolerance, loose = loosest(problem, batch, max(PERMITTED_ERROR, own_error))
        all_ = engine, loose, by_heyoka(problem, USUAL_TOLERANCE, batch)
        runs = [[integrate(problem.starts, problem.duration) for integrate in all_] for _ in range(REPEATS)]
        seconds = [min(run.seconds for run in of_one) for of_one in zip(*runs, strict=True)]
        energy_errors = [problem.energy_error(run.states) for run in runs[0]]
        state_errors = [state_error(problem, integrate) for integrate in all_]
        cells: list[Any] = [name, f"{ORBITS * problem.duration / seconds[0]:.3g}"]
        for k in range(3):
            cells += [f"{seconds[k] / seconds[0]:.2f}"] * (k > 0) + [f"{tolerance:g}"] * (k == 1)
            cells += [f"{energy_errors[k]:.1e}", f"{state_errors[k]:.1e}"]
        print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
