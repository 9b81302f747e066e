"""Compare which points are inside the exits, and their area, with the parts of a lattice on which V is below the energy."""

from __future__ import annotations

from engine.exits.interior import find_outside_channels
from tests.referee.report import Report
from tests.referee.setting import Setting

CHECK = "interior"


def check_interior(setting: Setting, _seed: int, report: Report) -> None:
    """Compare points that are inside or outside also if walls and exits are a step thicker or thinner."""
    lattice = setting.lattice
    inside, perhaps = lattice.surely_inside, lattice.perhaps_inside
    for name, mask, is_inside in (("inside", inside, True), ("outside", lattice.is_allowed & ~perhaps, False)):
        points = lattice.points(mask)
        found = find_outside_channels(setting.potential, setting.energy, *points.T) == 0
        wrong = points[found != is_inside]
        known = {"places": wrong[:3].tolist(), "number": len(wrong)} | setting.reproduction
        report.judge(CHECK, f"points {name} are not", not len(wrong), **known)
    if perhaps[[0, -1]].any() or perhaps[:, [0, -1]].any():
        return
    low, high = (float(mask.sum() * lattice.step**2) for mask in (inside, perhaps))
    area = setting.flux.area
    report.judge(CHECK, "another area is inside", low <= area <= high, area=area, own=[low, high], **setting.reproduction)
