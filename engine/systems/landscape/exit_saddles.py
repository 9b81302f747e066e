"""Saddles of a potential that lead out of the well at the origin, and the maxima beside them.

Two lines of steepest descent start at a saddle, one on each side along the unstable direction. If one line ends at the origin and
the other line ends elsewhere, at another minimum or at infinity, the saddle is an exit of the well. Two lines of steepest ascent
run along the walls of the channel. If a line ends at a maximum, the channel has no wall there above the energy of the maximum. A
line that reaches a curve where V is infinite, such as x = 3 for V = 1/(x − 3), ends there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import NO_POINTS
from engine.systems.landscape.descents import Descents
from engine.systems.landscape.mirror_images import Signs, make_symmetric, without_rounding


def find_exit_lines(form: Form, points: np.ndarray, indices: np.ndarray, poles: np.ndarray = NO_POINTS) -> np.ndarray:
    """Return lines of steepest descent from the well or pole at the origin over the saddles that lead out of it.

    Parameters
    ----------
    form
        The function V.
    points
        All critical points, of shape (n, 2). A point at the origin is exactly (0, 0). If the origin is neither a minimum nor a
        pole, no point leads out.
    indices
        −1 for saddles, 1 for minima and maxima, of shape (n,).
    poles
        Points where V is not defined and lines of steepest descent can end, of shape (m, 2).

    Returns
    -------
    The index of the saddle, x and y of each place on the lines, of shape (places, 3). Each line begins near the origin.
    """
    # Where the index is 1, the sign of V_xx tells minima from maxima.
    sinks = np.concatenate([points[(indices > 0) & (form.hessian(*points.T)[0] > 0.0)], poles])
    all_points = np.concatenate([points, poles])
    is_saddle = np.concatenate([indices < 0, np.zeros(len(poles), bool)])
    rows = [np.empty((0, 3))]
    if not np.any(np.hypot(*sinks.T) == 0.0) or len(all_points) < 2:
        return rows[0]
    origin = int(np.flatnonzero(np.hypot(*all_points.T) == 0.0)[0])
    saddles = np.flatnonzero(is_saddle)
    for k, lines in zip(saddles, Descents(form, 1.0, all_points, is_saddle).find_all(saddles), strict=True):
        inward, outward = sorted(lines, key=lambda each: origin not in each)
        if origin in inward and origin not in outward:
            # Both lines begin at the saddle.
            places = np.concatenate([inward[origin][::-1], next(iter(outward.values()), NO_POINTS)[1:]])
            rows.append(np.column_stack([np.full(len(places), k), places]))
    return np.concatenate(rows)


def find_maxima_beside(form: Form, points: np.ndarray, indices: np.ndarray, saddles: np.ndarray) -> np.ndarray:
    """Return, for each saddle and each critical point, whether a line of steepest ascent from the saddle ends there; (m, n).

    Parameters
    ----------
    form
        The function V.
    points
        All critical points, of shape (n, 2).
    indices
        −1 for saddles, 1 for minima and maxima, of shape (n,).
    saddles
        Indices of saddles among the points, of shape (m,).
    """
    flags = np.zeros((len(saddles), len(points)), bool)
    if not len(saddles) or not np.any((indices > 0) & (form.hessian(*points.T)[0] < 0.0)):
        return flags
    ascents = Descents(form, -1.0, points, indices < 0).find_all(saddles)
    for row, (lines, other_lines) in zip(flags, ascents, strict=True):
        row[[end for end in lines | other_lines if end >= 0]] = True
    return flags


def in_channel_order(saddles: np.ndarray, mirrors: Sequence[Signs]) -> np.ndarray:
    """Sort exit saddles (n, 2) counterclockwise from the +x axis, and make zeros and the symmetry under `mirrors` exact."""
    # The sign of a rounding error would change the channel numbers on the +x axis.
    rounded = without_rounding(saddles)
    angle = np.arctan2(rounded[:, 1], rounded[:, 0]) % (2 * np.pi)
    ordered = rounded[np.argsort(angle, kind="stable")]
    return make_symmetric(ordered, ordered, mirrors)
