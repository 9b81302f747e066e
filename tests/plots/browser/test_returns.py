"""The section that the browser paints has the points of the server."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine import Fate, MapSpec, System, compute_returns, parse_formula, read_section
from engine.slices.portable_system import make_portable_system
from tests.node import needs_node, run_node

SIDE = 6
# Orbits of a regular well with units of its own, of an open well, and of a rotating frame with a body.
CASES = [
    (parse_formula("8x² + 8y² − 3x³ + 9xy²"), 1.0, "y = 0 up"),
    (parse_formula("8x² + 8y² − 3x³ + 9xy²"), 1.0, "x = 0, px < 0"),
    (System("III").potential, 0.3, "y = 0.1 down"),
    (System("Hill").potential, -2.5, "y = 0 down"),
    (System("I").potential, 0.08, "y = 0.1 both"),
    (System("III").potential, 0.2, "apsis"),
]


@needs_node
@pytest.mark.parametrize(("potential", "energy", "text"), CASES)
def test_returns_in_the_browser_are_those_of_the_server(potential, energy: float, text: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    section = read_section(text)
    plane = section.slice_of_starts
    spec = MapSpec(potential, plane, energy, (SIDE, SIDE), t_max=630.0 * potential.units.time, section=section)
    expected = compute_returns(spec, returns=1000)
    portable, window = make_portable_system(potential, energy, section), spec.find_window()
    described = plane.to_dict(potential.units) | {"sectionColumns": section.columns_on(plane)}
    edges = ("xLow", "xHigh", "ordinateLow", "ordinateHigh")
    corners = dict(zip(edges, (*window.ranges[0], *window.ranges[1]), strict=True))
    starts = {"slice": described, "energy": energy, "window": corners, "side": SIDE, "duration": spec.t_max, "most": 1000}
    sent = {"system": portable.to_dict(), "module": portable.module, "starts": starts}
    found, channels = run_node("run_returns.js", sent, tmp_path).values()
    assert len(found) > 3
    of_orbits = expected.fate[(expected.fate != Fate.FORBIDDEN) & (expected.fate != Fate.OUTSIDE)]
    assert channels == {str(k): fate for k, fate in enumerate(of_orbits.tolist()) if fate > 0}
    wanted = expected.points()
    for points, returns in zip(wanted, found.values(), strict=True):
        # The errors of both integrations grow along an orbit.
        distance = np.linalg.norm(np.array(returns)[:6, None] - points[None, :12], axis=2).min(axis=1)
        assert distance.max() < 1e-8 * potential.units.length
        # Of two returns within a short time, the browser gives one.
        assert -0.03 * len(points) - 1 <= len(returns) - len(points) <= 1
