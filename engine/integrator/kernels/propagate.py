"""The loop over steps that propagates many orbits until they escape, reach a horizon or use up a budget of steps.

The kernel is compiled once for all potentials: `step` and `jets` are the addresses of the functions of one potential, see
`engine.integrator.jit.function_pointers`. Vector code steps a fixed number of lanes together, and a lane whose orbit ends takes
the next orbit. The vector step sets flags for lanes that need scalar code. Steps that contain an exit, the horizon or possibly
hidden crossings are collected in a buffer, and the series of a full buffer are computed together. The arithmetic of an orbit does
not depend on the other lanes, so results do not depend on the order of the orbits, on the budget or on the threads.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_step
from engine.integrator.kernels.events import (
    BOUNDED,
    FAILED,
    NOT_COMPUTED,
    count_crossings,
    crossed_exit,
    find_exit_time,
    passed_exit,
    series_slope,
    series_value,
)
from engine.integrator.kernels.exit_geometry import CLOSED, SHAPE, reached_exit
from engine.integrator.kernels.lanes import fill_vectors, has_failed, move_lane
from engine.integrator.source.recurrence import LANES, REMAINDER_ROW, ROWS, SIZE_ROW, TIME_ROW
from engine.integrator.source.series import ORDER
from engine.integrator.source.step_flags import CROSSES, GATE, HIDDEN, NEAR, OVERSHOOT

NO_TRACE = np.empty((0, 5))
"""The argument `trace` of `propagate` for orbits whose steps are not recorded."""

GOES_ON = -1
"""Channel, in the buffer of steps, of an orbit that does not end in the step."""


class Exits(NamedTuple):
    """Exits at one or more energies, and the surface of section.

    Attributes
    ----------
    gates
        (exits + rows, 3) three numbers for each exit, the same for all energies. For a channel, they are g_x, g_y and g: an orbit
        can be outside only beyond the line g_x x + g_y y = g. For a disc or the escape circle, they are its centre and its
        radius. Further rows describe the section at which crossings are counted, see `engine.integrator.kernels.sections`.
    curves
        (energies, exits, columns) exits, see `engine.integrator.kernels.exit_geometry`.
    curve_row
        (n,) the row of `curves` for each orbit.
    """

    gates: np.ndarray
    curves: np.ndarray
    curve_row: np.ndarray


class Orbits(NamedTuple):
    """Arrays of n orbits, changed in place by `propagate`.

    Attributes
    ----------
    state
        (n, 4) x, y, px, py at time `t`.
    t
        (n,) time reached: the escape time, or the start of the next step.
    crossings
        (n,) crossings of the section until `t`.
    last_crossings
        (n,) crossings between `t` and t_max, for bounded orbits.
    fate
        (n,) int8: the number of the exit at which an orbit ended, BOUNDED, NOT_COMPUTED or FAILED.
    pending
        (n,) uint8: set to 0 when an orbit has escaped, failed or reached the horizon.
    remainder
        (n, 2) rounding errors of x and y at time `t`; 0 if steps do not carry them.
    """

    state: np.ndarray
    t: np.ndarray
    crossings: np.ndarray
    last_crossings: np.ndarray
    fate: np.ndarray
    pending: np.ndarray
    remainder: np.ndarray


class _StepBuffer(NamedTuple):
    """Steps whose events have not been located yet.

    start (4, lanes): state at the start of each step; h (lanes,): its size; orbit (lanes,): the number of its orbit; channel
    (lanes,): the channel through which the orbit escapes, 0 if the step passes the horizon, or GOES_ON; x_jet, y_jet (ORDER + 1,
    lanes): work space for the series; section_jet: that of the form of a section.
    """

    start: np.ndarray
    h: np.ndarray
    orbit: np.ndarray
    channel: np.ndarray
    x_jet: np.ndarray
    y_jet: np.ndarray
    section_jet: np.ndarray


@subroutine
def make_buffer(lanes):
    """Return an empty buffer for as many steps as there are lanes."""
    h, orbit, channel = np.zeros(lanes), np.zeros(lanes, np.int64), np.zeros(lanes, np.int64)
    x_jet, y_jet, section_jet = np.zeros((ORDER + 1, lanes)), np.zeros((ORDER + 1, lanes)), np.zeros((ORDER + 1, lanes))
    return _StepBuffer(np.zeros((4, lanes)), h, orbit, channel, x_jet, y_jet, section_jet)


@kernel
def propagate(step, jets, coefficients, todo, horizon, final, tolerance, budget, least_active, exits, orbits, trace):
    """Propagate the orbits numbered `todo` until they escape, pass `horizon`, or `budget` steps of lanes are taken.

    The kernel also ends when no orbits wait and fewer than `least_active` are active, because they would not fill the lanes. With
    `final`, the horizon is t_max: events of the last, partial step are located, and an orbit still inside becomes BOUNDED.
    Without `final`, such an orbit stays NOT_COMPUTED. Returns the total number of steps of all orbits.

    exits: `Exits`; orbits: `Orbits`, changed in place; trace (m, 5): set to x, y, px, py, t at the start of each step of the
    first lane, until `trace` is full; `NO_TRACE` for more than one orbit.
    """
    # Only `np.zeros` is used: Numba takes about 0.1 s to compile each function that makes arrays, for each type of array.
    now, new = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES))
    flag, crossed, lane_orbit = np.zeros(LANES, np.int64), np.zeros(LANES, np.int64), np.zeros(LANES, np.int64)
    buffer, buffered = make_buffer(LANES), 0
    # A buffer for one step; it has two lanes, because WebAssembly computes the series of pairs.
    single = make_buffer(2)
    active = min(LANES, todo.shape[0])
    next_orbit, taken, traced, left = active, 0, 0, budget
    _begin_lanes(orbits, todo, active, now, lane_orbit, crossed)
    while active > 0 and left > 0 and (active >= least_active or next_orbit < todo.shape[0]):
        if traced < trace.shape[0]:
            _trace_step(now, trace, traced)
            traced += 1
        width = fill_vectors(active)
        call_step(step, coefficients, width, tolerance, horizon, exits.gates, now, new, flag, crossed)
        taken += active
        left -= width
        # The loop runs downward, because the last active lane replaces a lane whose orbit has ended.
        for i in range(active - 1, -1, -1):
            if flag[i] == 0:
                continue
            orbit = lane_orbit[i]
            ends, channel, fails, has_events = _judge_step(jets, coefficients, flag[i], now, new, i, final, exits, orbit, single)
            if ends:
                _end_orbit(now, i, crossed, orbits, orbit, fails)
            if has_events:
                _buffer_step(now, new, i, orbit, channel if ends else GOES_ON, buffer, buffered)
                buffered += 1
                if buffered == LANES:
                    _locate_events(jets, coefficients, buffer, buffered, horizon, exits, orbits)
                    buffered = 0
            elif not ends:
                crossed[i] += 1 if flag[i] & CROSSES != 0 else 0
            if ends:
                active, next_orbit = _refill_lane(orbits, todo, next_orbit, active, new, i, lane_orbit, crossed)
        now, new = new, now
    if buffered > 0:
        _locate_events(jets, coefficients, buffer, buffered, horizon, exits, orbits)
    for i in range(active):
        _store_orbit(now, i, crossed, orbits, lane_orbit[i])
    return taken


@subroutine
def _begin_lanes(orbits, todo, active, lanes, lane_orbit, crossed):
    """Load the first `active` orbits; lanes without an orbit take harmless steps that never reach the horizon."""
    lanes[0] = 0.01
    lanes[TIME_ROW] = -np.inf
    for i in range(active):
        _load_orbit(orbits, todo[i], lanes, i, lane_orbit, crossed)


@subroutine
def _trace_step(now, trace, number):
    """Record the start of a step of the first lane."""
    for c in range(5):
        trace[number, c] = now[c, 0]


@subroutine
def _end_orbit(now, i, crossed, orbits, orbit, fails):
    """Store the orbit of lane i, which ends in this step; its events may still have to be located."""
    _store_orbit(now, i, crossed, orbits, orbit)
    orbits.pending[orbit] = 0
    orbits.fate[orbit] = FAILED if fails else NOT_COMPUTED


@subroutine
def _refill_lane(orbits, todo, next_orbit, active, lanes, i, lane_orbit, crossed):
    """Load the next orbit into lane i, or move the last active lane there; return the number of lanes and the next orbit."""
    if next_orbit < todo.shape[0]:
        _load_orbit(orbits, todo[next_orbit], lanes, i, lane_orbit, crossed)
        return active, next_orbit + 1
    move_lane(lanes, active - 1, i, lane_orbit)
    crossed[i] = crossed[active - 1]
    return active - 1, next_orbit


@subroutine
def _judge_step(jets, coefficients, flags, now, new, i, final, exits, orbit, single):
    """Return whether an orbit ends in a flagged step, the exit crossed or 0, whether it fails, and whether to locate events.

    now, new: lanes at the start and the end of the step; i: lane of the orbit; single: buffer for one step.
    """
    fails = has_failed(new, i)
    is_late = flags & OVERSHOOT != 0
    curves = exits.curves[exits.curve_row[orbit]]
    channel = 0
    if not is_late and flags & (GATE | NEAR) != 0:
        channel = crossed_exit(now[0, i], now[1, i], new[0, i], new[1, i], curves, exits.gates)
    if flags & NEAR != 0 and not is_late and channel == 0 and not fails:
        channel = passes_exit(jets, coefficients, now, i, new[SIZE_ROW, i], curves, single)
    ends = is_late or channel > 0 or fails
    has_events = channel > 0 or (is_late and final) or (not is_late and flags & HIDDEN != 0)
    return ends, channel, fails, has_events and not fails


@subroutine
def passes_exit(jets, coefficients, now, i, h, curves, buffer):
    """Return the number of the exit that the orbit of lane i crosses and recrosses within the step of size h; 0 for none."""
    start = buffer.start
    for c in range(4):
        start[c, 0] = now[c, i]
    call_jets(jets, coefficients, 1, start[0], start[1], start[2], start[3], buffer.x_jet, buffer.y_jet)
    return passed_exit(buffer.x_jet, buffer.y_jet, 0, h, curves)


@subroutine
def _load_orbit(orbits, orbit, lanes, i, lane_orbit, crossed):
    """Load an orbit into lane i of the (ROWS, LANES) array `lanes`."""
    for c in range(4):
        lanes[c, i] = orbits.state[orbit, c]
    lanes[TIME_ROW, i] = orbits.t[orbit]
    for c in range(2):
        lanes[REMAINDER_ROW + c, i] = orbits.remainder[orbit, c]
    lane_orbit[i] = orbit
    crossed[i] = 0


@subroutine
def _store_orbit(lanes, i, crossed, orbits, orbit):
    """Store lane i of the (ROWS, LANES) array `lanes` in its orbit."""
    for c in range(4):
        orbits.state[orbit, c] = lanes[c, i]
    orbits.t[orbit] = lanes[TIME_ROW, i]
    for c in range(2):
        orbits.remainder[orbit, c] = lanes[REMAINDER_ROW + c, i]
    orbits.crossings[orbit] += crossed[i]


@subroutine
def _buffer_step(now, new, i, orbit, channel, buffer, k):
    """Store the step of lane i in place k of the buffer."""
    for c in range(4):
        buffer.start[c, k] = now[c, i]
    buffer.h[k] = new[SIZE_ROW, i]
    buffer.orbit[k] = orbit
    buffer.channel[k] = channel


@subroutine
def _locate_events(jets, coefficients, buffer, n, horizon, exits, orbits):
    """Locate the events in the first `n` buffered steps: crossings and, for orbits that end, the exit and its time."""
    start, x_jet, y_jet, work = buffer.start, buffer.x_jet, buffer.y_jet, buffer.section_jet
    section = exits.gates[exits.curves.shape[1] :]
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        orbit = buffer.orbit[i]
        h = buffer.h[i]
        channel = buffer.channel[i]
        # The series of the whole step is used, so that the escape time is the same to the bit for every horizon.
        tau, is_bounded = h, False
        curves = exits.curves[exits.curve_row[orbit]]
        if channel != GOES_ON:
            if channel == 0:
                x_end, y_end = series_value(x_jet, i, h), series_value(y_jet, i, h)
                channel = crossed_exit(start[0, i], start[1, i], x_end, y_end, curves, exits.gates)
                if channel == 0:
                    channel = passed_exit(x_jet, y_jet, i, h, curves)
            if channel > 0:
                tau = find_exit_time(x_jet, y_jet, i, h, curves[channel - 1])
            is_bounded = channel == 0 or orbits.t[orbit] + tau > horizon
        # There is one call, because each call would be another copy of the code.
        count = count_crossings(x_jet, y_jet, i, horizon - orbits.t[orbit] if is_bounded else tau, section, work)
        if is_bounded:
            # The state stays at the start of the step that would pass t_max, so that the orbit can be continued.
            orbits.last_crossings[orbit] = count
            orbits.fate[orbit] = BOUNDED
            continue
        orbits.crossings[orbit] += count
        if channel == GOES_ON:
            continue
        orbits.t[orbit] += tau
        orbits.state[orbit, 0] = series_value(x_jet, i, tau)
        orbits.state[orbit, 1] = series_value(y_jet, i, tau)
        orbits.state[orbit, 2] = series_slope(x_jet, i, tau)
        orbits.state[orbit, 3] = series_slope(y_jet, i, tau)
        orbits.remainder[orbit] = 0.0
        channel = reached_exit(orbits.state[orbit, 0], orbits.state[orbit, 1], channel, curves)
        # Only rounding errors can carry an orbit at rest on the saddle of a closed channel over this saddle.
        orbits.fate[orbit] = BOUNDED if curves[channel - 1, SHAPE] == CLOSED else channel
