"""Compare which points are inside the exits, and their area, with the parts of a lattice on which V is below the energy."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from engine.exits.interior import find_outside_channels
from tests.referee.report import Report
from tests.referee.setting import Setting

CHECK = "interior"
_SIDE = 401
# Half the side of the lattice in units of the distance of the farthest exit.
_REACH = 1.5
# Number of points between two points of an exit.
_BETWEEN = 40


def check_interior(setting: Setting, _seed: int, report: Report) -> None:
    """Compare points that are inside or outside also if walls and exits are a cell thicker or thinner."""
    if not setting.exits.channels:
        return
    reach = _REACH * setting.size
    side = np.linspace(-reach, reach, _SIDE)
    is_allowed = setting.system.value(side[:, None], side) < setting.energy
    walls = _cells_of_exits(setting, reach)
    thick = ndimage.binary_dilation(walls, np.ones((3, 3)))
    surely_inside = _joined(ndimage.binary_erosion(is_allowed, np.ones((3, 3))) & ~thick)
    perhaps_inside = _joined(ndimage.binary_dilation(is_allowed, np.ones((3, 3))) & ~walls) | thick
    x, y = np.meshgrid(side, side, indexing="ij")
    for name, points, is_inside in (("inside", surely_inside, True), ("outside", is_allowed & ~perhaps_inside, False)):
        found = find_outside_channels(setting.potential, setting.energy, x[points], y[points]) == 0
        wrong = np.flatnonzero(found != is_inside)
        places = np.column_stack([x[points], y[points]])[wrong[:3]].tolist()
        report.judge(CHECK, f"points {name} are not", not wrong.size, places=places, number=wrong.size, **setting.reproduction)
    edges = perhaps_inside[[0, -1]].any() or perhaps_inside[:, [0, -1]].any()
    if not edges:
        low, high = (float(cells.sum() * (side[1] - side[0]) ** 2) for cells in (surely_inside, perhaps_inside))
        area = setting.flux.area
        report.judge(CHECK, "another area is inside", low <= area <= high, area=area, own=[low, high], **setting.reproduction)


def _cells_of_exits(setting: Setting, reach: float) -> np.ndarray:
    """Return the cells on the paths of the exits."""
    cells = np.zeros((_SIDE, _SIDE), bool)
    for path in setting.exits.paths:
        steps = np.arange(0.0, len(path) - 1.0, 1.0 / _BETWEEN)
        points = np.column_stack([np.interp(steps, np.arange(len(path)), coordinate) for coordinate in path.T])
        places = np.rint((points + reach) / (2.0 * reach) * (_SIDE - 1)).astype(int)
        within = ((places >= 0) & (places < _SIDE)).all(axis=1)
        cells[tuple(places[within].T)] = True
    return cells


def _joined(mask: np.ndarray) -> np.ndarray:
    """Return the part of a lattice that contains the origin."""
    parts, _ = ndimage.label(mask)
    middle = _SIDE // 2
    return mask & (parts == parts[middle, middle])
