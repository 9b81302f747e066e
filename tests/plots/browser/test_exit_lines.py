"""Exits on the page are lines or circles, and orbits enter over saddles only."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from engine import CASES, Potential, find_lyapunov_orbits, parse_formula
from engine.slices.portable_system import make_portable_system
from engine.systems.outcomes import Centre
from tests.node import needs_node, run_node

DISC, RADIUS = Centre(0.3, 0.1, 0.05), 3.0


def look_at(potential: Potential, energy: float, folder: Path) -> Any:
    """Return what `run_exits.js` finds at an energy."""
    portable = make_portable_system(potential, 2.0 * energy)
    data: dict[str, Any] = {"system": portable.to_dict(), "module": portable.module, "positions": [0.0]}
    return run_node("run_exits.js", data | {"energies": [energy / potential.units.energy]}, folder)[0]


@needs_node
def test_circles_are_closed_curves_at_their_radius_without_a_number(tmp_path: Path) -> None:
    potential = parse_formula("2(x² + y²)").with_outcomes([DISC], RADIUS)
    lines = look_at(potential, 0.3, tmp_path)["lines"]
    assert [line["channel"] for line in lines] == [1, 2]
    for line, (x, y, radius) in zip(lines, [(DISC.x, DISC.y, DISC.radius), (0.0, 0.0, RADIUS)], strict=True):
        xs, ys = np.array(line["xs"]), np.array(line["ys"])
        np.testing.assert_allclose(np.hypot(xs - x, ys - y), radius, rtol=1e-12)
        assert np.hypot(xs[0] - xs[-1], ys[0] - ys[-1]) < 1e-12
        assert line["label"] == [None, None]


@needs_node
def test_orbits_enter_over_saddles_only_and_inward(tmp_path: Path) -> None:
    potential, energy = CASES["I"].with_outcomes([DISC]), 0.25
    assert potential.units.length == 1.0
    states = np.array(look_at(potential, energy, tmp_path)["entrances"]).reshape(-1, 4)
    paths = [orbit.half_path for orbit in find_lyapunov_orbits(CASES["I"], energy)]
    assert len(states) == 50
    assert cKDTree(np.concatenate(paths)).query(states[:, :2])[0].max() < 0.01
    saddles = CASES["I"].saddles
    nearest = saddles[cKDTree(saddles).query(states[:, :2])[1]]
    assert (np.sum(nearest * states[:, 2:], axis=1) < 0.0).all()


@needs_node
def test_no_orbits_enter_through_circles(tmp_path: Path) -> None:
    potential = parse_formula("2(x² + y²)").with_outcomes([DISC], RADIUS)
    assert look_at(potential, 0.3, tmp_path)["entrances"] == []
