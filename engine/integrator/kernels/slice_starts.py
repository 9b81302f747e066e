"""Starts at the points of a slice, in units of the well.

Kernels call the subroutines with numbers, and `engine.slices.slice_starts` calls them with arrays, so both use the same formulas.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_potential_value

# Columns of the coordinates that vary along the axes of a slice: the state, an angle of the velocity, and the energy.
X, Y, PX, PY, ANGLE, H = range(6)
# Number of these columns.
COORDINATES = 6

# Codes for what the energy determines: besides PX and PY, the speed at an angle from the x axis or from the radius.
LAUNCHED, LAUNCHED_FROM_RADIUS = 6, 7


@subroutine
def interval_centre(low, high, index, count):
    """Return the centre of one of `count` equal parts of an interval; the centres are exactly symmetric if the interval is."""
    return 0.5 * (low + high) + (high - low) * ((2 * index + 1 - count) / (2 * count))


@subroutine
def rest_energy(momentum, value):
    """Return the energy of a start whose determined momentum is 0; momentum: the other momentum; value: V at the start."""
    return 0.5 * (momentum * momentum) + value


@subroutine
def decided_momentum(energy, value, momentum, sign):
    """Return the momentum that the energy and the other momentum determine, with a sign; NaN where the start is forbidden."""
    return sign * np.sqrt(2.0 * (energy - value) - momentum * momentum)


@subroutine
def launch(speed, angle):
    """Return px and py of a velocity with a speed, at an angle from the x axis."""
    return speed * np.cos(angle), speed * np.sin(angle)


@subroutine
def launch_from_radius(x, y, speed, angle):
    """Return px and py of a velocity with a speed, at an angle from the direction away from the origin.

    At the origin the radial direction is undefined; the +y direction is used, which is its own mirror image under x → −x.
    """
    radius = np.hypot(x, y)
    at_origin = 1.0 * (radius == 0.0)
    away_x, away_y = x / (radius + at_origin), (y + at_origin) / (radius + at_origin)
    cosine, sine = np.cos(angle), np.sin(angle)
    return speed * (cosine * away_x - sine * away_y), speed * (cosine * away_y + sine * away_x)


@subroutine
def _place(motion, points, i, start):
    """Set the coordinates of a start (COORDINATES,); the momentum that the energy determines is still that of `motion`."""
    for column in range(COORDINATES):
        start[column] = motion[0, column]
        for axis in range(points.shape[0]):
            start[column] += motion[1 + axis, column] * points[axis, i]


@subroutine
def _fixed_momentum(start, decided):
    """Return the momentum that the energy does not determine; 0 if the energy determines the speed."""
    momentum = 0.0
    if decided == PX:
        momentum = start[PY]
    elif decided == PY:
        momentum = start[PX]
    return momentum


@kernel
def find_starts(potential_value, coefficients, motion, decided, sign, points, states, energies):
    """Set `states` (4, n) to the starts of points, NaN where they are forbidden, and `energies` (n,).

    motion (1 + axes, COORDINATES): the coordinates at the origin of the slice, then their change per unit along each axis;
    decided: PX, PY, LAUNCHED or LAUNCHED_FROM_RADIUS; sign: sign of the determined momentum; points (axes, n).
    """
    start = np.zeros(COORDINATES)
    for i in range(points.shape[1]):
        _place(motion, points, i, start)
        value = call_potential_value(potential_value, coefficients, start[X], start[Y])
        # The speed, if the energy determines the speed.
        momentum = decided_momentum(start[H], value, _fixed_momentum(start, decided), sign)
        if decided == LAUNCHED:
            start[PX], start[PY] = launch(momentum, start[ANGLE])
        elif decided == LAUNCHED_FROM_RADIUS:
            start[PX], start[PY] = launch_from_radius(start[X], start[Y], momentum, start[ANGLE])
        else:
            start[decided] = momentum
        for row in range(4):
            states[row, i] = start[row]
        energies[i] = start[H]


@kernel
def find_required_energies(potential_value, coefficients, motion, decided, window, required):
    """Set `required` (rows, columns) to the lowest energies at which starts exist, on a lattice that includes the edges.

    window (4,): lowest and highest abscissa and ordinate; motion, decided: as in `find_starts`. If the energy is an axis, values
    are relative to the energy of each point.
    """
    rows, columns = required.shape
    start = np.zeros(COORDINATES)
    point = np.zeros((2, 1))
    for row in range(rows):
        point[1, 0] = window[2] + (window[3] - window[2]) * row / (rows - 1)
        for column in range(columns):
            point[0, 0] = window[0] + (window[1] - window[0]) * column / (columns - 1)
            _place(motion, point, 0, start)
            value = call_potential_value(potential_value, coefficients, start[X], start[Y])
            required[row, column] = rest_energy(_fixed_momentum(start, decided), value) - start[H]


@kernel
def interpolate_window(energies, windows, energy, window):
    """Set `window` (4,) by linear interpolation in a table of windows; return whether the energy is within the table.

    energies (n,): rising; windows (n, 4).
    """
    count = energies.shape[0]
    if count == 0 or not energies[0] <= energy <= energies[count - 1]:
        return False
    above = 0
    while energies[above] < energy:
        above += 1
    below = max(above - 1, 0)
    share = 0.0
    if energies[above] > energies[below]:
        share = (energy - energies[below]) / (energies[above] - energies[below])
    for edge in range(4):
        window[edge] = windows[below, edge] + share * (windows[above, edge] - windows[below, edge])
    return True
