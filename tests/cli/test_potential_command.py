"""Command ``potential`` prints critical points as a table and as JSON."""

from __future__ import annotations

import json

from engine import CASES
from tests.cli.conftest import Run


def test_critical_points_of_the_json_and_of_the_table_are_those_of_the_potential(run: Run) -> None:
    _, out, _ = run("potential", "II", "--json")
    found = json.loads(out)
    saddles = [(one["x"], one["y"]) for one in found["critical_points"] if one["channel"]]
    assert sorted(saddles) == sorted(map(tuple, CASES["II"].saddles.tolist()))
    assert found["escape_energy"] == CASES["II"].escape_energy
    _, out, _ = run("potential", "II")
    for x, y in CASES["II"].saddles.tolist():
        assert f"({x:.9g}, {y:.9g})" in out
