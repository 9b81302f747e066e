"""The loop around the step: lanes that never idle, and the few steps in which something happened set aside for a look.

Compiled once for all potentials: `step` and `jets` are the addresses of one potential's (see `calls`). Orbits live in the
caller's arrays; up to `lanes` of them ride in the lanes at a time. The vector step tells by a flag which lanes
need a scalar look; exits, last steps and possible hidden crossings go to a small buffer whose jets are computed together.
No orbit's arithmetic depends on its neighbours, so results do not depend on lane width, order, budget or threads.
"""

from __future__ import annotations

import numpy as np

from engine.taylor.jit.decorator import kernel
from engine.taylor.jit.function_pointers import call_jets, call_step
from engine.taylor.kernels.events import (
    BOUNDED,
    FAILED,
    NOT_COMPUTED,
    count_upward_crossings,
    find_exit_time,
    outside_channel,
    series_slope,
    series_value,
)
from engine.taylor.source.recurrence import GATE, HIDDEN, ORDER, OVERSHOOT

# Arrays of lanes are padded to whole vectors, so that no lane is ever computed by different (scalar) code.
VECTOR = 16

_LEAVES, _STAYS = 0, 1


@kernel
def resolve(
    jets, coefficients, n, orbit, leaves, start, h, horizon, curves, curve_row, state, t, crossings, last_crossings, fate
):
    """Look into `n` whole steps set aside: count their upward crossings and, for orbits that leave, settle the fate."""
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        j = orbit[i]
        if leaves[i] == _STAYS:
            crossings[j] += count_upward_crossings(y_jet, i, h[i])
            continue
        curve = curves[curve_row[j]]
        channel = outside_channel(series_value(x_jet, i, h[i]), series_value(y_jet, i, h[i]), curve)
        # The whole step decides, so that an exit has the same time to the bit whatever the horizon.
        tau = find_exit_time(x_jet, y_jet, i, h[i], curve[channel - 1]) if channel > 0 else h[i]
        if channel == 0 or t[j] + tau > horizon:
            # Resumable: the state stays at the start of the step that would pass t_max.
            last_crossings[j] = count_upward_crossings(y_jet, i, horizon - t[j])
            fate[j] = BOUNDED
            continue
        crossings[j] += count_upward_crossings(y_jet, i, tau)
        t[j] += tau
        state[j, 0] = series_value(x_jet, i, tau)
        state[j, 1] = series_value(y_jet, i, tau)
        state[j, 2] = series_slope(x_jet, i, tau)
        state[j, 3] = series_slope(y_jet, i, tau)
        fate[j] = channel


@kernel
def advance(
    step, jets, coefficients, todo, horizon, final, tolerance, budget, lanes, gates, curves, curve_row,
    state, t, crossings, last_crossings, fate, waiting,
):  # fmt: skip
    """Carry orbits on until they leave, pass `horizon`, or `budget` steps are spent.

    todo: numbers of the orbits to carry on; state (n, 4), t, crossings, last_crossings, fate, waiting: of all orbits,
    changed in place. waiting[j] turns 0 when orbit j has left or reached the horizon. With `final` the horizon is t_max:
    the last, partial step is looked into and an orbit still inside is BOUNDED; without, it stays NOT_COMPUTED.
    Returns the number of steps taken.
    """
    now = np.empty((5, lanes))
    new = np.empty((5, lanes))
    for row in range(4):
        now[row] = 0.0
    now[0] = 0.01
    now[4] = -np.inf
    h = np.empty(lanes)
    flag = np.zeros(lanes, np.int64)
    crossed = np.zeros(lanes, np.int64)
    rider = np.empty(lanes, np.int64)
    aside_start = np.zeros((4, lanes))
    aside_h = np.zeros(lanes)
    aside_orbit = np.zeros(lanes, np.int64)
    aside_leaves = np.zeros(lanes, np.int64)
    aside = 0
    riding = 0
    following = 0
    taken = 0
    while riding < lanes and following < todo.shape[0]:
        j = todo[following]
        following += 1
        for c in range(4):
            now[c, riding] = state[j, c]
        now[4, riding] = t[j]
        rider[riding] = j
        riding += 1
    while riding > 0 and taken < budget:
        width = (riding + VECTOR - 1) // VECTOR * VECTOR
        call_step(
            step, coefficients, width, tolerance, horizon, gates, now[0], now[1], now[2], now[3], now[4],
            new[0], new[1], new[2], new[3], new[4], h, flag, crossed,
        )  # fmt: skip
        taken += riding
        i = riding
        while i > 0:
            i -= 1
            flagged = flag[i]
            if flagged == 0:
                continue
            j = rider[i]
            channel = 0
            failed = not (np.isfinite(new[0, i]) and np.isfinite(new[1, i]) and h[i] > 0.0)
            late = flagged & OVERSHOOT != 0
            if not late and flagged & GATE != 0:
                channel = outside_channel(new[0, i], new[1, i], curves[curve_row[j]])
            look = channel > 0 or (late and final) or (not late and flagged & HIDDEN != 0)
            leaves = late or channel > 0 or failed
            if leaves:
                for c in range(4):
                    state[j, c] = now[c, i]
                t[j] = now[4, i]
                crossings[j] += crossed[i]
                waiting[j] = 0
                fate[j] = FAILED if failed else NOT_COMPUTED
            if look and not failed:
                for c in range(4):
                    aside_start[c, aside] = now[c, i]
                aside_h[aside] = h[i]
                aside_orbit[aside] = j
                aside_leaves[aside] = _LEAVES if leaves else _STAYS
                aside += 1
                if aside == lanes:
                    resolve(
                        jets, coefficients, aside, aside_orbit, aside_leaves, aside_start, aside_h, horizon,
                        curves, curve_row, state, t, crossings, last_crossings, fate,
                    )  # fmt: skip
                    aside = 0
            elif not leaves and now[1, i] < 0.0 and new[1, i] >= 0.0:
                crossed[i] += 1
            if not leaves:
                continue
            if following < todo.shape[0]:
                j = todo[following]
                following += 1
                for c in range(4):
                    new[c, i] = state[j, c]
                new[4, i] = t[j]
                rider[i] = j
                crossed[i] = 0
            else:
                riding -= 1
                for c in range(5):
                    new[c, i] = new[c, riding]
                rider[i] = rider[riding]
                crossed[i] = crossed[riding]
        now, new = new, now
    if aside > 0:
        resolve(
            jets, coefficients, aside, aside_orbit, aside_leaves, aside_start, aside_h, horizon,
            curves, curve_row, state, t, crossings, last_crossings, fate,
        )  # fmt: skip
    for i in range(riding):
        j = rider[i]
        for c in range(4):
            state[j, c] = now[c, i]
        t[j] = now[4, i]
        crossings[j] += crossed[i]
    return taken


@kernel
def trace(step, coefficients, start, begin, end, tolerance, gates, steps):
    """The starts of the steps of one orbit from time `begin` up to `end`, as `advance` takes them, until `steps` is full.

    steps (m, 5): x, y, px, py, t at the start of each step. Returns how many were written; when the last step reaches `end`
    it is fewer than m, otherwise the last row is where to go on from.
    """
    now = np.zeros((5, VECTOR))
    new = np.zeros((5, VECTOR))
    h = np.empty(VECTOR)
    flag = np.zeros(VECTOR, np.int64)
    crossed = np.zeros(VECTOR, np.int64)
    for c in range(4):
        now[c] = start[c]
    now[4] = begin
    count = 0
    while count < steps.shape[0]:
        for c in range(5):
            steps[count, c] = now[c, 0]
        count += 1
        call_step(
            step, coefficients, VECTOR, tolerance, end, gates, now[0], now[1], now[2], now[3], now[4],
            new[0], new[1], new[2], new[3], new[4], h, flag, crossed,
        )  # fmt: skip
        if flag[0] & OVERSHOOT != 0:
            return count
        now, new = new, now
    return count
