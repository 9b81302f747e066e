"""Exits as rows of numbers: their distance from a point, their points, and their interpolation in a table of energies.

An exit is a place where orbits end: a curve or line across a channel, the edge of a disc around a body, or the escape circle. It
is a row of numbers, which has an origin and a half width for all shapes. The origin of a disc is its centre, and the half width
of a disc or of the escape circle is the radius; MIDDLE is 0, and the first coefficient is π. The escape circle can be divided
into arcs, each an exit: MIDDLE is the angle of its middle and the first coefficient half its angle, in radians, BEARING is the
direction of its middle, and REACH is the cosine of half its angle.

In a well that does not rotate, an exit is the path of a Lyapunov orbit. The coordinates are u outward and q across, 90°
counterclockwise from u; u is measured from the saddle along its unstable direction, or from the chord of the orbit, normal
to the chord. The exit is the graph u = f(s) of a polynomial f, with s = (q − middle)/half_width ∈ [−1, 1]. Beyond its ends, which
lie on the zero-velocity curve, straight lines continue the exit through the forbidden region, up to |s| = reach. A closed channel
is a short straight line across its saddle, in the forbidden region but for the saddle itself. In a rotating frame, an exit is a
"line": a parabola u = c + a q² along the ridge of V at the saddle.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine

# Columns of an exit. BEARING is the direction from the origin to the saddle.
ORIGIN_X, ORIGIN_Y, OUTWARD_X, OUTWARD_Y, BEARING_X, BEARING_Y, REACH, SHAPE = range(8)
MIDDLE, HALF_WIDTH, SLOPE_LOW, SLOPE_HIGH, COEFFICIENTS = range(8, 13)

# Values of the column SHAPE, in this order: hidden returns are searched from LINE on, and shapes from DISC on are circles.
CLOSED, CURVE, LINE, DISC, CIRCLE, ARC = range(6)

# Degree of the polynomial f, a sum of Chebyshev polynomials.
CURVE_DEGREE = 40
CURVE_COLUMNS = COEFFICIENTS + CURVE_DEGREE + 1

# Columns of a table: the gate, the reach, then copies of the columns ORIGIN_X to OUTWARD_Y, then of MIDDLE and all that follow.
GATE_COLUMN, REACH_COLUMN, AXES_COLUMN, MIDDLE_COLUMN = 0, 1, 2, 6


@subroutine
def is_circle(curve):
    """Return whether an exit is a circle, or an arc of one: the edge of a disc or the escape circle."""
    return curve[SHAPE] >= DISC


@subroutine
def is_open_channel(curve):
    """Return whether an exit is the curve or line of an open channel."""
    return CURVE <= curve[SHAPE] < DISC


@subroutine
def ends_inside(curve):
    """Return whether orbits end on the inner side of an exit, as at a disc."""
    return curve[SHAPE] == DISC


@subroutine
def reached_exit(x, y, number, curves):
    """Return the number of the exit that an orbit reaches at a point: for an arc, the arc of the circle around the point."""
    if curves[number - 1, SHAPE] != ARC:
        return number
    radius = np.sqrt(x * x + y * y)
    nearest, largest = number, -np.inf
    for k in range(curves.shape[0]):
        excess = (x * curves[k, BEARING_X] + y * curves[k, BEARING_Y]) / radius - curves[k, REACH]
        if curves[k, SHAPE] == ARC and excess > largest:
            nearest, largest = k + 1, excess
    return nearest


@subroutine
def position_across(x, y, curve):
    """Return the coordinate s of a point; −1 and 1 are the ends of the exit."""
    q = curve[OUTWARD_X] * (y - curve[ORIGIN_Y]) - curve[OUTWARD_Y] * (x - curve[ORIGIN_X])
    return (q - curve[MIDDLE]) / curve[HALF_WIDTH]


@subroutine
def exit_height(s, curve):
    """Return f(s) of an exit over a saddle, with the straight lines beyond its ends."""
    line_height = 0.0
    if s < -1.0:
        line_height = curve[SLOPE_LOW] * (s + 1.0)
        s = -1.0
    elif s > 1.0:
        line_height = curve[SLOPE_HIGH] * (s - 1.0)
        s = 1.0
    # Clenshaw's recurrence.
    f = 0.0
    last = 0.0
    for k in range(CURVE_DEGREE, 0, -1):
        f, last = 2.0 * s * f - last + curve[COEFFICIENTS + k], f
    return s * f - last + curve[COEFFICIENTS] + line_height


@subroutine
def exit_distance(x, y, curve):
    """Return the distance of (x, y) from an exit, along the channel or the radius: positive outside, negative inside."""
    if is_circle(curve):
        radius = np.sqrt((x - curve[ORIGIN_X]) ** 2 + (y - curve[ORIGIN_Y]) ** 2)
        return curve[HALF_WIDTH] - radius if ends_inside(curve) else radius - curve[HALF_WIDTH]
    u = curve[OUTWARD_X] * (x - curve[ORIGIN_X]) + curve[OUTWARD_Y] * (y - curve[ORIGIN_Y])
    return u - exit_height(position_across(x, y, curve), curve)


@subroutine
def _interpolate_exit(nodes, rows, sigma, shape, exit_curve, gate):
    """Set an exit (columns,) and its gate (3,), both zeros initially, from a table.

    sigma: value among the nodes; 0.0 or less for a closed channel. The barycentric formula is used (Berrut & Trefethen 2004, SIAM
    Review 46, 501), except for the reach. The reach is not smooth, so the smaller one of two neighbours is used.
    """
    count = nodes.shape[0]
    exit_curve[OUTWARD_X] = 1.0
    exit_curve[REACH] = 1.0
    exit_curve[HALF_WIDTH] = 1.0
    exit_curve[SHAPE] = CLOSED
    gate[0] = 1.0
    gate[2] = np.inf
    if count == 0 or not sigma > 0.0:
        return
    # The sums begin at 0.
    exit_curve[SHAPE] = shape
    exit_curve[OUTWARD_X] = 0.0
    exit_curve[HALF_WIDTH] = 0.0
    gate[2] = 0.0
    above = 0
    while above < count and nodes[above] < sigma:
        above += 1
    # At a node, this node alone counts.
    first, last, total = 0, count, 0.0
    if above < count and nodes[above] == sigma:
        first, last = above, above + 1
    for k in range(first, last):
        weight = 1.0
        if last - first > 1:
            weight = np.sin(np.pi * (2 * k + 1) / (2 * count)) / (sigma - nodes[k])
            weight = weight if k % 2 == 0 else -weight
        total += weight
        gate[2] += weight * rows[k, GATE_COLUMN]
        for column in range(AXES_COLUMN, MIDDLE_COLUMN):
            exit_curve[ORIGIN_X + column - AXES_COLUMN] += weight * rows[k, column]
        for column in range(MIDDLE_COLUMN, rows.shape[1]):
            exit_curve[MIDDLE + column - MIDDLE_COLUMN] += weight * rows[k, column]
    gate[2] /= total
    for column in range(ORIGIN_X, OUTWARD_Y + 1):
        exit_curve[column] /= total
    for column in range(MIDDLE, exit_curve.shape[0]):
        exit_curve[column] /= total
    neighbour = max(above - 1, 0) if last - first > 1 else above
    exit_curve[REACH] = min(rows[neighbour, REACH_COLUMN], rows[min(above, count - 1), REACH_COLUMN])
    length = np.sqrt(exit_curve[OUTWARD_X] ** 2 + exit_curve[OUTWARD_Y] ** 2)
    exit_curve[OUTWARD_X] /= length
    exit_curve[OUTWARD_Y] /= length
    gate[0] = exit_curve[OUTWARD_X]
    gate[1] = exit_curve[OUTWARD_Y]


@subroutine
def exit_point(exit_curve, s):
    """Return x and y of the point of an exit at s, from −1 to 1; on a circle, this range is a full turn or the arc."""
    if is_circle(exit_curve):
        angle = exit_curve[MIDDLE] + exit_curve[COEFFICIENTS] * s
        x = exit_curve[ORIGIN_X] + exit_curve[HALF_WIDTH] * np.cos(angle)
        y = exit_curve[ORIGIN_Y] + exit_curve[HALF_WIDTH] * np.sin(angle)
    else:
        u = exit_height(s, exit_curve)
        q = exit_curve[MIDDLE] + exit_curve[HALF_WIDTH] * s
        x = exit_curve[ORIGIN_X] + u * exit_curve[OUTWARD_X] - q * exit_curve[OUTWARD_Y]
        y = exit_curve[ORIGIN_Y] + u * exit_curve[OUTWARD_Y] + q * exit_curve[OUTWARD_X]
    return x, y


@kernel
def exit_points(exit_curve, positions, points):
    """Set `points` (2, n) to the points of an exit at s (n,), see `exit_point`."""
    for i in range(positions.shape[0]):
        points[0, i], points[1, i] = exit_point(exit_curve, positions[i])


@kernel
def locate_points(exit_curve, x, y, distance, position):
    """Set the distances (n,) of points x, y (n,) from an exit, and their positions s (n,), see `exit_distance`."""
    for i in range(x.shape[0]):
        distance[i] = exit_distance(x[i], y[i], exit_curve)
        position[i] = position_across(x[i], y[i], exit_curve)


@kernel
def interpolate_exit(nodes, rows, saddle, shape, energies, number, curves, gates):
    """Set exit `number` in `curves` (n, exits, columns) at energies (n,) and its gate in `gates` (exits, 3), zeros initially.

    nodes (m,): values of √(h − saddle), rising Chebyshev nodes of the first kind; saddle: the energy at which the channel opens;
    rows (m, columns): the exit at each node; shape: CURVE or LINE. Of the gates at all energies, the lowest is chosen, because
    this gate lies inside all these exits.
    """
    gate = np.zeros(3)
    for i in range(energies.shape[0]):
        gate[:] = 0.0
        sigma = np.sqrt(max(energies[i] - saddle, 0.0))
        _interpolate_exit(nodes, rows, sigma, shape, curves[i, number], gate)
        if i == 0 or gate[2] < gates[number, 2]:
            for k in range(3):
                gates[number, k] = gate[k]
