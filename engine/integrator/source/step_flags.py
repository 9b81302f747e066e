"""Tests for events in a step, as operations that are appended to the straight-line program of the step."""

from __future__ import annotations

from engine.integrator.source.series import ORDER, Series, Setting
from engine.integrator.source.straight_line import StraightLine, Value, where

HIDDEN = 1
"""Flag of a step that may hide crossings of the section."""

GATE = 2
"""Flag of a step that ends beyond the gate of an exit."""

OVERSHOOT = 4
"""Flag of a step that ends after the time `horizon`."""

NEAR = 8
"""Flag of a step that may cross and recross an exit, so that the step can end before the gate."""

CROSSES = 16
"""Flag, besides others, of a step that crosses the section between its ends."""

# Maxima of σ − σ^k for 0 ≤ σ ≤ 1, by k, rounded up; for larger k, 1 is used.
_LARGEST_SAGS = {2: 0.25, 3: 0.385, 4: 0.473}


def _bend(series: Series, h: Value) -> Value:
    """Return ½ Σ_{k≥2} |y_k| (2h)^k, which is at least twice the distance of y from its chord over a step."""
    two_h = h + h
    bound = abs(series[ORDER])
    for k in reversed(range(2, ORDER)):
        bound = bound * two_h + abs(series[k])
    return bound * two_h * h


def largest_sag(series: Series, h: Value) -> Value:
    """Return Σ_{k≥2} max(σ − σ^k) |x_k| h^k, which is at least the distance of a coordinate from its chord over a step."""
    bound = abs(series[ORDER])
    for k in reversed(range(2, ORDER)):
        bound = bound * h + (_LARGEST_SAGS.get(k, 1.0) * abs(series[k]))
    return bound * h * h


def flag_hidden_crossings(y: Series, end: Value, h: Value) -> Value:
    """Return the test of a step for hidden zeros of a series, such as y, with the value `end` at its end: HIDDEN or 0.

    The bound of `_bend` is at least h · max|ẏ − ẏ(0)|. Therefore there are no hidden crossings if ẏ keeps its sign
    (|ẏ(0)| h > bound), or if both ends lie on one side, farther away than bound/2.
    """
    bound = _bend(y, h)
    start_distance, end_distance = abs(y[0]), abs(end)
    distance = where(start_distance < end_distance, start_distance, end_distance)
    return where(abs(y[1]) * h > bound, 0, where((y[0] * end > 0.0) & (distance > 0.5 * bound), 0, HIDDEN))


def flag_gates(
    setting: Setting, program: StraightLine, series: tuple[Series, Series], end: tuple[Value, Value], h: Value
) -> tuple[dict[str, tuple[int, int]], Value]:
    """Return the inputs of the gates, with their places (row, column) in `gates`, and the flag of a step: GATE, NEAR or 0.

    A row of `gates` is g_x, g_y, g. For a channel, the row stands for the line g_x x + g_y y = g. For a circle, the row contains
    the centre and the radius.
    """
    count = setting.channels + len(setting.sides)
    # Suffixes of the names of inputs, with their columns.
    columns = {"x": 0, "y": 1, "": 2}
    places = {f"g{k}{name}": (k, column) for k in range(count) for name, column in columns.items()}
    flag = program.constant(0)
    rows = [[program.input(f"g{k}{name}") for name in columns] for k in range(count)]
    lines, circles = rows[: setting.channels], rows[setting.channels :]
    if not setting.needs_whole_steps:
        for g_x, g_y, g in lines:
            flag = where(g_x * end[0] + g_y * end[1] > g, GATE, flag)
        return places, flag
    start = series[0][0], series[1][0]
    # All points of the step are within this distance of its chord.
    sag = largest_sag(series[0], h) + largest_sag(series[1], h)
    half_chord = 0.5 * (abs(end[0] - start[0]) + abs(end[1] - start[1]))
    for g_x, g_y, g in lines:
        for x, y in (start, end):
            flag = where(g_x * x + g_y * y + sag > g, NEAR, flag)
    for side, (c_x, c_y, radius) in zip(setting.sides, circles, strict=True):
        squares = [(x - c_x) * (x - c_x) + (y - c_y) * (y - c_y) for x, y in (start, end)]
        edge = radius + (sag + half_chord) if side < 0 else where(radius > sag, radius - sag, 0.0)
        for square in squares:
            flag = where(square < edge * edge if side < 0 else square > edge * edge, NEAR, flag)
    return places, flag
