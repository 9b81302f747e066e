"""Starts at the points of a slice, in units of the well, and the pixels of a picture with the outcomes of their orbits.

Kernels call the subroutines with numbers, and `engine.slices.slice_starts` calls them with arrays, so both use the same formulas.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_potential_value
from engine.integrator.kernels.events import BOUNDED, FORBIDDEN, NOT_COMPUTED, OUTSIDE

# Columns of the coordinates that vary along the axes of a slice: the state, an angle of the velocity, and the energy.
X, Y, PX, PY, ANGLE, H = range(6)
# Number of these columns.
COORDINATES = 6

# Codes for what the energy determines: besides PX and PY, the speed at an angle from the x axis or from the radius.
LAUNCHED, LAUNCHED_FROM_RADIUS = 6, 7

# Largest reported number of crossings: the largest integer of 16 bits.
_MOST_CROSSINGS = 65535.0


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
    # Arithmetic in place of a branch, because x and y may be arrays.
    at_origin = 1.0 * (radius == 0.0)
    away_x, away_y = x / (radius + at_origin), (y + at_origin) / (radius + at_origin)
    cosine, sine = np.cos(angle), np.sin(angle)
    return speed * (cosine * away_x - sine * away_y), speed * (cosine * away_y + sine * away_x)


@subroutine
def _place(motion, points, i, start):
    """Set the coordinates of a start (COORDINATES,) at point i of `points` (axes, n); motion: as in `find_starts`.

    The momentum that the energy determines is set later.
    """
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


@kernel
def place_pixels(window, columns, rows, part_rows, part_columns, energy_axis, points, energy_rows):
    """Set `points` (2, n) to the centres of the pixels in some rows (m,) of a picture and in its first columns, row by row.

    window (4,): lowest and highest abscissa and ordinate; columns, rows: size of the whole picture; energy_axis: 0, 1, or −1 for
    none. energy_rows (n,) is set to the index of each pixel in the part along the axis of the energy; 0 without such an axis.
    """
    for part_row in range(part_rows.shape[0]):
        ordinate = interval_centre(window[2], window[3], part_rows[part_row], rows)
        for column in range(part_columns):
            pixel = part_row * part_columns + column
            points[0, pixel] = interval_centre(window[0], window[1], column, columns)
            points[1, pixel] = ordinate
            energy_rows[pixel] = column if energy_axis == 0 else part_row if energy_axis == 1 else 0


@kernel
def select_starts(states, outside, rows, fate, kept, kept_states, kept_rows):
    """Select the starts that exist and lie inside all exits, and return their number; the `fate` (n,) of other starts is set.

    states (4, n): NaN where forbidden; outside (n,): number of an exit, 0 for none; rows (n,): rows of the exits at the energies;
    kept (n,), kept_states (n, 4), kept_rows (n,): set to the indices, the states and the rows of the selected starts.
    """
    count = 0
    for i in range(outside.shape[0]):
        if not (np.isfinite(states[2, i]) and np.isfinite(states[3, i])):
            fate[i] = FORBIDDEN
        elif outside[i] > 0:
            fate[i] = OUTSIDE
        else:
            kept[count] = i
            kept_rows[count] = rows[i]
            for row in range(4):
                kept_states[count, row] = states[row, i]
            count += 1
    return count


@kernel
def report_ends(orbits, kept, fate, time, crossings):
    """Set `fate` (n,), `time` (n,) of the escape or NaN, and `crossings` (n,) at the pixels `kept` of the orbits.

    Orbits that are inside at the horizon are undecided. For `orbits` see `engine.integrator.kernels.propagate.Orbits`.
    """
    for k in range(orbits.t.shape[0]):
        pixel, code = kept[k], orbits.fate[k]
        fate[pixel] = NOT_COMPUTED if code == BOUNDED else code
        time[pixel] = orbits.t[k] if code > 0 else np.nan
        crossings[pixel] = min(float(orbits.crossings[k] + orbits.last_crossings[k]), _MOST_CROSSINGS)
