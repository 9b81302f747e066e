"""Passages of orbits through y = 0 downward before they escape, with adaptive steps: sections of the tubes of unstable manifolds.

Compiled once for all potentials, as `engine.integrator.kernels.propagate`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_step
from engine.integrator.kernels.events import append_crossings, crossed_exit, find_exit_time
from engine.integrator.kernels.propagate import VECTOR
from engine.integrator.source.recurrence import LANES, ROWS
from engine.integrator.source.series import ORDER
from engine.integrator.source.step_flags import GATE, HIDDEN, OVERSHOOT


class _StepBuffer(NamedTuple):
    """Steps whose passages are still to be located.

    start (6, lanes): x, y, px, py, t and step size; orbit (lanes,); channel (lanes,): where the step escapes, 0 for inside.
    """

    start: np.ndarray
    orbit: np.ndarray
    channel: np.ndarray


@kernel
def find_section_passages(step, jets, coefficients, tolerance, horizon, gates, curves, state, passages, found):
    """The first m downward passages of y = 0 of each orbit before it escapes through an exit or passes `horizon`.

    gates (channels, 3); curves (channels, columns); state (4, lanes), lanes a multiple of `VECTOR` up to `LANES`;
    passages (lanes, m, 3): x, px and time; found (lanes,), zeros. A passage goes from y > 0 to y ≤ 0; none is counted after the
    escape time.
    """
    lanes = state.shape[1]
    most = passages.shape[1]
    now = np.zeros((ROWS, LANES))
    # Element by element: for `now[:4] = state` Numba compiles an error message as well, which takes 2 s.
    for c in range(4):
        for i in range(lanes):
            now[c, i] = state[c, i]
    new = np.zeros((ROWS, LANES))
    flag = np.zeros(LANES, np.int64)
    crossed = np.zeros(LANES, np.int64)
    lane_orbit = np.zeros(lanes, np.int64)
    for i in range(lanes):
        lane_orbit[i] = i
    buffer = _StepBuffer(np.zeros((6, lanes)), np.zeros(lanes, np.int64), np.zeros(lanes, np.int64))
    buffered = 0
    active = lanes
    while active > 0:
        width = (active + VECTOR - 1) // VECTOR * VECTOR
        call_step(step, coefficients, width, tolerance, horizon, gates, now, new, flag, crossed)
        for i in range(active - 1, -1, -1):
            j = lane_orbit[i]
            full = found[j] == most
            down = now[1, i] > 0.0 and new[1, i] <= 0.0
            if flag[i] == 0 and not down and not full:
                continue
            late = flag[i] & OVERSHOOT != 0
            channel = 0
            if not late and flag[i] & GATE != 0:
                channel = crossed_exit(now[0, i], now[1, i], new[0, i], new[1, i], curves, gates)
            if not late and not full and (down or channel > 0 or flag[i] & HIDDEN != 0):
                for c in range(5):
                    buffer.start[c, buffered] = now[c, i]
                buffer.start[5, buffered] = new[5, i]
                buffer.orbit[buffered] = j
                buffer.channel[buffered] = channel
                buffered += 1
                if buffered == lanes:
                    _locate_passages(jets, coefficients, buffer, buffered, curves, passages, found)
                    buffered = 0
            if late or full or channel > 0:
                active -= 1
                for c in range(ROWS):
                    new[c, i] = new[c, active]
                lane_orbit[i] = lane_orbit[active]
        now, new = new, now
    _locate_passages(jets, coefficients, buffer, buffered, curves, passages, found)


@subroutine
def _locate_passages(jets, coefficients, buffer, n, curves, passages, found):
    """Append the downward passages in each of the first `n` buffered steps to those of the step's orbit."""
    start = buffer.start
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        duration = start[5, i]
        if buffer.channel[i] > 0:
            duration = find_exit_time(x_jet, y_jet, i, duration, curves[buffer.channel[i] - 1])
        append_crossings(x_jet, y_jet, i, -1.0, start[4, i], duration, passages, found, buffer.orbit[i])
