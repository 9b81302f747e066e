"""Compare the orbits classified per second on one core with heyoka with events, SciPy's DOP853 and a compiled Runge-Kutta loop.

All methods classify starts of the same map to the same t_max; slower methods classify a random sample.

Run: uv run python -m benchmarks.peers
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numba
import numpy as np
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as dop853

from engine import CASES, MapSpec, Plane, Potential, compute_map, start_states
from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import exit_gates
from engine.integrator.kernels.events import crossed_exit
from tests.peers import taylor_heyoka
from tests.peers.exit_lines import exit_lines

# Case and energy of each map.
MAPS = (("I", 0.19), ("III", 0.45))
T_MAX = 1000.0
# Number of starts that each method classifies.
SAMPLES = {"heyoka": 300, "scipy": 12, "numba": 2000}
HEYOKA_TOLERANCE, SCIPY_TOLERANCE, NUMBA_TOLERANCE = 2.2e-16, 1e-13, 1e-11


@contextmanager
def one_core() -> Iterator[ThreadPoolExecutor]:
    """Yield a pool with a single thread, on the same core as the calling thread."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        with ThreadPoolExecutor(1) as executor:
            yield executor
    finally:
        os.sched_setaffinity(0, cores)


def starts_of(spec: MapSpec) -> tuple[np.ndarray, np.ndarray]:
    """Return the interior starts of a map, of shape (n, 4), and their fates, of shape (n,)."""
    result = compute_map(spec)
    x, ordinate = np.meshgrid(result.x, result.ordinate)
    inside = result.interior
    return start_states(spec.potential, spec.plane, float(spec.energy), x[inside], ordinate[inside]), result.fate[inside]


def by_scipy(potential: Potential, energy: float, states: np.ndarray) -> np.ndarray:
    """Return the fates found by a straightforward use of `scipy.integrate.solve_ivp`, with an event for each exit."""
    lines = exit_lines(potential, energy)

    def motion(_t: float, s: np.ndarray) -> list[float]:
        vx, vy = potential.gradient(s[0], s[1])
        return [s[2], s[3], -vx, -vy]

    def past(line):
        def event(_t: float, s: np.ndarray) -> float:
            return float(line.past(s[0], s[1]))

        event.terminal, event.direction = True, 1.0
        return event

    def upward(_t: float, s: np.ndarray) -> float:
        return s[1]

    upward.direction = 1.0
    events = [*map(past, lines), upward]
    fate = np.zeros(len(states), int)
    for n, state in enumerate(states):
        tolerances = {"rtol": SCIPY_TOLERANCE, "atol": SCIPY_TOLERANCE}
        solution = solve_ivp(motion, (0.0, T_MAX), state, "DOP853", events=events, **tolerances)
        left = [line.channel for line, times in zip(lines, solution.t_events, strict=False) if len(times)]
        fate[n] = left[0] if left else 0
    return fate


# Coefficients of the method of order 8: stages, result and error estimate of order 5.
A, B, E5 = dop853.A[:12, :12].copy(), dop853.B.copy(), dop853.E5.copy()


@numba.njit(fastmath=True)
def runge_kutta(exponents, coefficients, states, t_max, tolerance, curves, gates):
    """Return fates and crossings, found by an adaptive Runge-Kutta method of order 8 that tests for both after each step.

    The final states are written into `states`.
    """
    fate = np.zeros(states.shape[0], np.int64)
    crossings = np.zeros(states.shape[0], np.int64)
    k, point, new, error = np.empty((13, 4)), np.empty(4), np.empty(4), np.empty(4)
    for n in range(states.shape[0]):
        s = states[n]
        t, h = 0.0, 0.1
        slope(exponents, coefficients, s, k[0])
        while t < t_max:
            h = min(h, t_max - t)
            for stage in range(1, 12):
                for c in range(4):
                    point[c] = s[c]
                    for j in range(stage):
                        point[c] += h * A[stage, j] * k[j, c]
                slope(exponents, coefficients, point, k[stage])
            for c in range(4):
                new[c] = s[c]
                for j in range(12):
                    new[c] += h * B[j] * k[j, c]
            slope(exponents, coefficients, new, k[12])
            size = 0.0
            for c in range(4):
                error[c] = 0.0
                for j in range(13):
                    error[c] += h * E5[j] * k[j, c]
                size = max(size, abs(error[c]) / tolerance)
            if size <= 1.0:
                crossings[n] += s[1] < 0.0 and new[1] >= 0.0
                channel = crossed_exit(s[0], s[1], new[0], new[1], curves, gates)
                s[:] = new
                k[0] = k[12]
                t += h
                if channel > 0:
                    fate[n] = channel
                    break
            h *= min(2.0, max(0.3, 0.9 * (1.0 / max(size, 1e-30)) ** 0.125))
    return fate, crossings


@numba.njit(fastmath=True)
def slope(exponents, coefficients, s, out):
    out[0], out[1], out[2], out[3] = s[2], s[3], 0.0, 0.0
    for term in range(coefficients.size):
        i, j = exponents[term]
        power_x = power_y = 1.0
        for _ in range(i - 1):
            power_x *= s[0]
        for _ in range(j - 1):
            power_y *= s[1]
        if i > 0:
            out[2] -= coefficients[term] * i * power_x * (power_y * s[1] if j > 0 else 1.0)
        if j > 0:
            out[3] -= coefficients[term] * j * power_y * (power_x * s[0] if i > 0 else 1.0)


def by_numba(potential: Potential, energy: float, states: np.ndarray) -> np.ndarray:
    exponents = np.array([term[:2] for term in potential.terms])
    coefficients = np.array([term[2] for term in potential.terms])
    after, curves = states.copy(), exit_curves(potential, energy)
    fate = runge_kutta(exponents, coefficients, after, T_MAX, NUMBA_TOLERANCE, curves, exit_gates(curves[None]))[0]
    bounded = fate == 0
    worst = np.max(np.abs(potential.energy(after[bounded]) / energy - 1)) if bounded.any() else np.nan
    print(f"(numba: worst energy error of a bounded orbit {worst:.1e})")
    return fate


def by_heyoka(potential: Potential, energy: float, states: np.ndarray) -> np.ndarray:
    return taylor_heyoka.classify(potential, exit_lines(potential, energy), states, T_MAX, HEYOKA_TOLERANCE).fate


PEERS: dict[str, Callable[[Potential, float, np.ndarray], np.ndarray]] = {
    "heyoka": by_heyoka,
    "scipy": by_scipy,
    "numba": by_numba,
}


def main() -> None:
    print("| case | h | method | orbits | orbits/s | this engine is faster by | differing fates |\n|---|---|---|---|---|---|---|")
    for case, energy in MAPS:
        potential = CASES[case]
        spec = MapSpec(potential, Plane.X_PX, energy, t_max=T_MAX)
        states, fates = starts_of(spec)
        with one_core() as executor:
            begin = time.perf_counter()
            compute_map(spec, executor=executor)
            engine_rate = len(states) / (time.perf_counter() - begin)
        print(f"| {case} | {energy} | this engine, whole map | {len(states)} | {engine_rate:.0f} | 1 | 0 |")
        order = np.random.default_rng(1).permutation(len(states))
        for name, classify in PEERS.items():
            part = order[: SAMPLES[name]]
            # The first call compiles.
            classify(potential, energy, states[part[:1]])
            begin = time.perf_counter()
            peer_fates = classify(potential, energy, states[part])
            rate = part.size / (time.perf_counter() - begin)
            differ = np.count_nonzero(peer_fates != fates[part])
            print(f"| {case} | {energy} | {name} | {part.size} | {rate:.1f} | {engine_rate / rate:.0f} | {differ} |", flush=True)


if __name__ == "__main__":
    main()
