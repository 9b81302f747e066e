"""Interpolated exits are those of the Lyapunov orbits, in Python and in JavaScript."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import CASES, POTENTIALS, Potential, find_lyapunov_orbits, parse_formula
from engine.exits.exit_tables import LARGEST_ERROR, tabulate_exits
from engine.slices.portable_system import make_portable_system
from tests.node import needs_node, run_node

HIGHEST = {"I": 0.5, "II": 0.5, "III": 1.0, "C5": 1.2}
SHARES = np.random.default_rng(2).uniform(0.0, 1.0, 12) ** 2
POSITIONS = np.cos(np.linspace(0.0, np.pi, 2001))


def some_energies(potential: Potential, highest: float) -> list[float]:
    return (potential.escape_energy + (highest - potential.escape_energy) * SHARES).tolist()


def distance(path: np.ndarray, points: np.ndarray) -> float:
    """Return the largest distance of the points of a path, of shape (m, 2), from the line through `points`, of shape (n, 2)."""
    nearest = cKDTree(points).query(path)[1]
    errors = []
    for point, k in zip(path, nearest.tolist(), strict=True):
        ends = points[max(k - 1, 0) : k + 2]
        along = np.diff(ends, axis=0)
        share = np.clip(np.sum((point - ends[:-1]) * along, axis=1) / np.sum(along**2, axis=1), 0.0, 1.0)
        errors.append(np.hypot(*(ends[:-1] + share[:, None] * along - point).T).min())
    return max(errors)


@pytest.mark.parametrize("name", HIGHEST)
def test_interpolated_exits_are_lyapunov_orbits(name: str) -> None:
    potential = POTENTIALS[name]
    tables = tabulate_exits(potential.in_well_units, HIGHEST[name] / potential.units.energy)
    for energy in some_energies(potential, HIGHEST[name]):
        for orbit in find_lyapunov_orbits(potential, energy):
            points = potential.units.length * tables[orbit.channel - 1].points_at(energy / potential.units.energy, POSITIONS)
            assert distance(orbit.half_path, points.T) < LARGEST_ERROR * potential.units.length


def test_a_table_ends_where_exits_cannot_be_interpolated() -> None:
    potential = parse_formula("½(x² + y²) − x²y² − x³/4").in_well_units
    merger = potential.well.channel_mergers[0].energy
    tables = tabulate_exits(potential, 2.0 * merger)
    assert all(table.saddle <= table.highest < merger for table in tables if table.saddle < merger)


def test_closed_channels_need_no_table() -> None:
    assert all(table.nodes.size == 0 and table.highest == 0.1 for table in tabulate_exits(CASES["I"], 0.1))


@needs_node
def test_the_browser_interpolates_the_same_exits(tmp_path: Path) -> None:
    potential = CASES["III"]
    portable = make_portable_system(potential, 1.0)
    energies, positions = some_energies(potential, 1.0), [-1.0, -0.3, 0.0, 0.8, 1.0]
    data = {"system": portable.to_dict(), "module": portable.module, "energies": energies, "positions": positions}
    found = np.array([each["points"] for each in run_node("run_exits.js", data, tmp_path)])
    expected = [[table.points_at(energy, np.array(positions)).T for table in portable.exits] for energy in energies]
    np.testing.assert_allclose(found, expected, atol=1e-12)
