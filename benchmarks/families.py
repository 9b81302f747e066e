"""Cost of an integration step against the number of channels: V = r²/2 − rⁿ cos nθ / n for n = 3 … 8, and the paper's cases.

Bounded orbits, one core. Multiply-adds are counted in the source of the step; its step-size rule and event tests are timed but
not counted.

Run: uv run python -m benchmarks.families
"""

from __future__ import annotations

import re
import time

import numpy as np
from numba import njit

from benchmarks.throughput import multiplications
from engine import CASES, Plane, Potential, start_states
from engine.exits.exit_rows import closed_exits, exit_gates
from engine.potentials.known_potentials import channel_family
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.jit.function_pointers import SIGNATURES
from engine.taylor.kernels.events import NOT_COMPUTED
from engine.taylor.kernels.propagate import NO_TRACE, Exits, Orbits
from engine.taylor.source.recurrence import TOLERANCE

ORBITS = 64
T_MAX = 300.0
REPEATS = 40
ENERGY = 0.9
"""In units of the escape energy."""


def step_nanoseconds(potential: Potential) -> float:
    """Time of one step of one orbit in the propagation loop of maps, in ns: the minimum of several runs."""
    energy = ENERGY * potential.escape_energy
    reach = np.sqrt(2.0 * energy)
    x, px = np.random.default_rng(1).uniform(-reach, reach, (2, 40 * ORBITS))
    states = start_states(potential, Plane.X_PX, energy, x, px)
    inside = np.isfinite(states).all(axis=1) & (np.abs(x) < np.hypot(*potential.saddles.T).min())
    starts = np.ascontiguousarray(states[inside][:ORBITS])
    curves = closed_exits(potential)[None]
    gates = exit_gates(curves)
    kernels = load_kernels(potential.terms, potential.channels)
    shortest = np.inf
    for _ in range(REPEATS):
        state, counts = starts.copy(), np.zeros((3, ORBITS), np.int64)
        fate, pending = np.full(ORBITS, NOT_COMPUTED, np.int8), np.ones(ORBITS, np.uint8)
        orbits = Orbits(state, np.zeros(ORBITS), counts[1], counts[2], fate, pending)
        exits = Exits(gates, curves, counts[0])
        started = time.thread_time()
        steps = kernels.propagate(np.arange(ORBITS), T_MAX, True, TOLERANCE, 2**62, 0, exits, orbits, NO_TRACE)
        shortest = min(shortest, (time.thread_time() - started) / steps)
    return shortest * 1e9


def vector_share(potential: Potential) -> float:
    """Share of packed multiplications in the machine code; 0.5 if the loop is vectorised, as its remainder is scalar."""
    step = njit(error_model="numpy", fastmath={"contract"})(
        load_kernels(potential.terms, potential.channels).step.function.py_func
    )
    step.compile(SIGNATURES["step"])
    assembly = "".join(step.inspect_asm().values())
    packed, scalar = (len(re.findall(rf"\bv(?:fn?m|mul)\w*{kind}\b", assembly)) for kind in ("pd", "sd"))
    return packed / (packed + scalar)


def main() -> None:
    print("| potential | channels | multiply-adds per step | ns per orbit and step | ns per multiply-add | vectorised |")
    print("|---|---|---|---|---|---|")
    named = {**CASES, **{f"n = {n}": channel_family(n) for n in range(3, 9)}}
    for name, potential in named.items():
        count, time_taken = multiplications(potential), step_nanoseconds(potential)
        vector = "yes" if vector_share(potential) >= 0.5 else "no"
        print(f"| {name} | {potential.channels} | {count} | {time_taken:.1f} | {time_taken / count:.3f} | {vector} |", flush=True)


if __name__ == "__main__":
    main()
