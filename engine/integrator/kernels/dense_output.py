"""Paths from dense output, for single orbits and for browsers, and deviation vectors from the linearised recurrence."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.jit.decorator import kernel
from engine.integrator.jit.function_pointers import call_jets
from engine.integrator.kernels.events import BOUNDED, NOT_COMPUTED, series_value
from engine.integrator.kernels.exit_geometry import CURVE_COLUMNS
from engine.integrator.kernels.lanes import VECTOR
from engine.integrator.kernels.propagate import Exits, Orbits
from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.section_numbers import UPWARD, SectionNumbers
from engine.integrator.source.series import ORDER

# Number of steps or samples that are processed together.
_CHUNK = 8192


def trace_orbit(
    kernels: ModuleType,
    exits: Exits,
    orbits: Orbits,
    t_max: float,
    execution: Execution = DEFAULT_EXECUTION,
) -> Iterator[tuple[np.ndarray, float]]:
    """Propagate one orbit until it escapes or to `t_max`, and yield its steps in pieces of at most `_CHUNK` steps.

    orbits: arrays of length 1, changed in place. Each piece is (m, 5) x, y, px, py, t at the start of its steps, and the time at
    which it ends. Even a bounded orbit can end before `t_max`, if it is at rest on the saddle of a closed channel and rounding
    carries it over the saddle. Raises CancelledError when cancelled.
    """
    while orbits.pending[0]:
        execution.raise_if_cancelled()
        steps = np.empty((_CHUNK, 5))
        # The budget counts all lanes of a vector, of which one orbit uses one.
        count = kernels.propagate(np.zeros(1, np.int64), t_max, True, TOLERANCE, VECTOR * _CHUNK, 0, exits, orbits, steps)
        goes_on = orbits.fate[0] == BOUNDED and orbits.t[0] == steps[count - 1, 4]
        yield steps[:count], t_max if goes_on else float(orbits.t[0])


def without_exits(outcome_count: int, orbits: int = 1, section: SectionNumbers = UPWARD) -> Exits:
    """Return exits that no orbit reaches; the kernels read a gate for each of the `outcome_count` outcomes of the potential."""
    # No step passes these gates: 0 x + 0 y = ∞.
    gates = np.full((outcome_count + len(section.rows), 3), np.inf)
    gates[:outcome_count, :2] = 0.0
    gates[outcome_count:] = np.reshape(section.rows, (len(section.rows), 3))
    return Exits(gates, np.zeros((1, outcome_count, CURVE_COLUMNS)), np.zeros(orbits, np.int64))


def trace_pieces(
    kernels: ModuleType,
    state: np.ndarray,
    t_end: float,
    outcome_count: int,
    execution: Execution = DEFAULT_EXECUTION,
) -> Iterator[tuple[np.ndarray, float]]:
    """Apply `trace_orbit` to a state (4,) from t = 0 to `t_end`, without exits, see `without_exits`."""
    exits = without_exits(outcome_count)
    fate = np.full(1, NOT_COMPUTED, np.int8)
    crossings, last_crossings = np.zeros((2, 1), np.int64)
    orbits = Orbits(state[None].copy(), np.zeros(1), crossings, last_crossings, fate, np.ones(1, np.uint8), np.zeros((1, 2)))
    return trace_orbit(kernels, exits, orbits, t_end, execution)


def trace_steps(
    kernels: ModuleType,
    state: np.ndarray,
    t_end: float,
    outcome_count: int,
    execution: Execution = DEFAULT_EXECUTION,
) -> np.ndarray:
    """Return x, y, px, py, t at the start of every step up to `t_end`, of shape (m, 5), see `trace_pieces`."""
    return np.concatenate([steps for steps, _ in trace_pieces(kernels, state, t_end, outcome_count, execution)])


def sample_path(
    kernels: ModuleType, steps: np.ndarray, times: np.ndarray, execution: Execution = DEFAULT_EXECUTION
) -> np.ndarray:
    """Return x, y, px, py at increasing `times`, of shape (4, n), from the series of the `steps` (m, 5) around these times."""
    row = np.searchsorted(steps[:, 4], times, side="right") - 1
    path = np.empty((4, times.size))
    for begin in range(0, len(steps), _CHUNK):
        execution.raise_if_cancelled()
        chunk = np.ascontiguousarray(steps[begin : begin + _CHUNK].T)
        series = np.empty((2, ORDER + 1, chunk.shape[1]))
        kernels.jets(chunk.shape[1], *chunk[:4], *series)
        in_chunk = slice(*np.searchsorted(row, [begin, begin + chunk.shape[1]]))
        chunk_row = row[in_chunk] - begin
        path[:, in_chunk] = _evaluate(series, chunk_row, times[in_chunk] - chunk[4, chunk_row])
    return path


def advance_states(kernels: ModuleType, states: np.ndarray, durations: np.ndarray) -> np.ndarray:
    """Return `states` (n, 4) after `durations` (n,) of at most one integrator step, with one series each."""
    series = np.empty((2, ORDER + 1, len(states)))
    kernels.jets(len(states), *(np.ascontiguousarray(column) for column in states.T), *series)
    return _evaluate(series, np.arange(len(states)), durations).T


def _evaluate(series: np.ndarray, row: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Return the states (4, n) that `evaluate_series` computes."""
    states = np.empty((4, row.size))
    evaluate_series(series, row, tau, states)
    return states


@kernel
def evaluate_series(series, row, tau, states):
    """Set `states` (4, n) to x, y, px, py at times tau (n,) after the start of steps `row` (n,) of series (2, ORDER + 1, m)."""
    order = series.shape[1] - 1
    for n in range(row.size):
        for axis in range(2):
            value = series[axis, order, row[n]]
            slope = 0.0
            for k in range(order - 1, -1, -1):
                slope = slope * tau[n] + value
                value = value * tau[n] + series[axis, k, row[n]]
            states[axis, n] = value
            states[axis + 2, n] = slope


def sample_deviations(
    kernels: ModuleType, path: np.ndarray, times: np.ndarray, vectors: np.ndarray, execution: Execution = DEFAULT_EXECUTION
) -> tuple[np.ndarray, np.ndarray]:
    """Return SALI and the growth ln(|w1(t)|/|w1(0)|) of deviation vectors at `times` (n,) along a path (4, n).

    vectors (2, 4): δx, δy, δpx, δpy of both vectors at the start of the path. The transition matrices of many intervals are
    computed together, and then applied in turn. The vectors are normalised after each interval. `times` must be at most one step
    of the integrator apart.
    """
    sali = np.empty(times.size)
    # Squared growth of the first vector in each interval.
    stretch = np.ones(times.size)
    w = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    sali[0] = min(np.linalg.norm(w[0] - w[1]), np.linalg.norm(w[0] + w[1]))
    for begin in range(0, times.size - 1, _CHUNK):
        execution.raise_if_cancelled()
        end = min(begin + _CHUNK, times.size - 1)
        matrices = transition_matrices(kernels, path[:, begin:end], np.diff(times[begin : end + 1]))
        # The kernel changes its other arguments in place.
        _apply_matrices(matrices, w, sali[begin + 1 : end + 1], stretch[begin + 1 : end + 1])
    return sali, 0.5 * np.cumsum(np.log(stretch))


def transition_matrices(kernels: ModuleType, path: np.ndarray, durations: np.ndarray) -> np.ndarray:
    """Return the matrices of the linearised flow over n intervals, of shape (4, 4, n): row, column, interval."""
    n = durations.size
    state = [np.ascontiguousarray(row) for row in path]
    matrices = np.zeros((4, 4, n))
    for column in range(4):
        w = np.zeros((4, n))
        w[column] = 1.0
        # The kernel changes the rows of w in place.
        kernels.tangent(n, durations, *state, *w)
        matrices[:, column] = w
    return matrices


@kernel
def _apply_matrices(matrices, w, sali, stretch):
    """Apply the matrices (4, 4, n) in turn to the vectors w (2, 4), in place, and normalise the vectors after each matrix.

    sali (n,) is set to SALI after each matrix, and stretch (n,) to the squared growth of the first vector by each matrix.
    """
    products = np.empty((2, 4))
    for n in range(sali.size):
        for v in range(2):
            square = 0.0
            for row in range(4):
                total = 0.0
                for column in range(4):
                    total += matrices[row, column, n] * w[v, column]
                products[v, row] = total
                square += total * total
            for row in range(4):
                w[v, row] = products[v, row] / np.sqrt(square)
            if v == 0:
                stretch[n] = square
        difference = 0.0
        sum_ = 0.0
        for row in range(4):
            difference += (w[0, row] - w[1, row]) ** 2
            sum_ += (w[0, row] + w[1, row]) ** 2
        sali[n] = np.sqrt(min(difference, sum_))


# The following kernels are for browsers, which can call generated functions only through kernels.


@kernel
def compute_series(jets, coefficients, start, series):
    """Set `series` (2, ORDER + 1, n) to the series of x and y of the steps that begin at `start` (4, n); n is even."""
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], series[0], series[1])


@kernel
def sample_steps(jets, coefficients, steps, count, end, path):
    """Set `path` (2, count · m) to x and y at m equally spaced times in each of the first `count` steps, the end included.

    steps (n, 5): x, y, px, py, t at the start of each step; end: the time at which the last of the `count` steps ends.
    """
    points = path.shape[1] // count
    # Two steps are processed at a time, because WebAssembly computes the series of pairs.
    start = np.zeros((4, 2))
    x_series, y_series = np.zeros((ORDER + 1, 2)), np.zeros((ORDER + 1, 2))
    for first in range(0, count, 2):
        for k in range(2):
            for row in range(4):
                start[row, k] = steps[min(first + k, count - 1), row]
        call_jets(jets, coefficients, 2, start[0], start[1], start[2], start[3], x_series, y_series)
        for k in range(min(2, count - first)):
            step = first + k
            size = (steps[step + 1, 4] if step + 1 < count else end) - steps[step, 4]
            for point in range(points):
                tau = size * (point + 1) / points
                path[0, step * points + point] = series_value(x_series, k, tau)
                path[1, step * points + point] = series_value(y_series, k, tau)
