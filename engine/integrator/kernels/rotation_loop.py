"""The closed curve through points of a rotation: the order of the points, and the distance of the curve from their polygon."""

from __future__ import annotations

import math

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine


@kernel
def arrange_loop(points, loop):
    """Write points (n, 2) into `loop` (n, 2), sorted along their closed curve; return the largest height of an arc.

    Return −1 if the points are not on a closed curve. The neighbours of the first point on the curve are its nearest returns
    ahead and behind, after a and b steps. As no other point is nearer, there are at most a + b points (three-gap theorem, Sós
    1958). They are in the order of the rotation by p/(a + b), where p a ≡ 1 modulo a + b.
    """
    a, b = _nearest_returns(points)
    if a == 0 or b == 0 or points.shape[0] > a + b:
        return -1.0
    p = _inverse(a, a + b)
    if p == 0:
        return -1.0
    # Index of the point at each position along the curve; −1 for a position without a point.
    point_at = np.full(a + b, -1)
    position = 0
    for i in range(points.shape[0]):
        point_at[position] = i
        position = (position + p) % (a + b)
    n = 0
    for i in point_at:
        if i >= 0:
            loop[n, 0] = points[i, 0]
            loop[n, 1] = points[i, 1]
            n += 1
    return _largest_arc_height(loop)


@subroutine
def _nearest_returns(points):
    """Return the steps to the nearest later point on either side of the first point, the nearer point first; 0 for no point."""
    nearest = 1
    for i in range(2, points.shape[0]):
        if _squared_distance(points, i) < _squared_distance(points, nearest):
            nearest = i
    ahead_x, ahead_y = points[nearest, 0] - points[0, 0], points[nearest, 1] - points[0, 1]
    behind = 0
    for i in range(1, points.shape[0]):
        if (points[i, 0] - points[0, 0]) * ahead_x + (points[i, 1] - points[0, 1]) * ahead_y > 0.0:
            continue
        if behind == 0 or _squared_distance(points, i) < _squared_distance(points, behind):
            behind = i
    return nearest, behind


@subroutine
def _squared_distance(points, i):
    """Return the squared distance of point i from the first point."""
    return (points[i, 0] - points[0, 0]) ** 2 + (points[i, 1] - points[0, 1]) ** 2


@subroutine
def _inverse(a, modulus):
    """Return p with p a ≡ 1, by Euclid's algorithm; 0 if a and the modulus have a common divisor."""
    remainder, next_remainder = modulus, a
    p, next_p = 0, 1
    while next_remainder:
        quotient = remainder // next_remainder
        remainder, next_remainder = next_remainder, remainder - quotient * next_remainder
        p, next_p = next_p, p - quotient * next_p
    return p % modulus if remainder == 1 else 0


@subroutine
def _largest_arc_height(loop):
    """Return the largest height of the curve's arc over a gap of a loop (n, 2), from the larger turn at the ends of the gap."""
    n = loop.shape[0]
    largest = 0.0
    turn = _turn(loop, 0)
    for i in range(n):
        next_turn = _turn(loop, (i + 1) % n)
        gap = math.hypot(loop[(i + 1) % n, 0] - loop[i, 0], loop[(i + 1) % n, 1] - loop[i, 1])
        largest = max(largest, gap * max(turn, next_turn) / 8.0)
        turn = next_turn
    return largest


@subroutine
def _turn(loop, i):
    """Return the angle by which the polygon turns at its point i."""
    n = loop.shape[0]
    x, y = loop[i, 0] - loop[i - 1, 0], loop[i, 1] - loop[i - 1, 1]
    next_x, next_y = loop[(i + 1) % n, 0] - loop[i, 0], loop[(i + 1) % n, 1] - loop[i, 1]
    return abs(math.atan2(x * next_y - y * next_x, x * next_x + y * next_y))
