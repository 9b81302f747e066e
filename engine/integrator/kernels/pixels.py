"""Pixels of a part of a picture: their points, the starts inside the exits, and the outcomes of their orbits."""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel
from engine.integrator.kernels.events import BOUNDED, FORBIDDEN, NOT_COMPUTED, OUTSIDE
from engine.integrator.kernels.slice_starts import interval_centre

# Largest reported number of crossings: the largest integer of 16 bits.
_MOST_CROSSINGS = 65535.0


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
