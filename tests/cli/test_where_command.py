"""The command ``where`` prints and writes what `find_where` returns."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from engine import CASES, ParameterAxis, Plane, SweepSpec, find_where, open_result
from tests.cli.conftest import Run

SEARCH = ("--quantity", "share_bounded", "--value", 0.2, "--resolution", 20, "--t-max", 100)


def test_the_answer_is_that_of_the_engine(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("where", "I", *SEARCH, "--low", 0.15, "--high", 0.2, "--json", "--output", tmp_path / "where")
    wanted = find_where(SweepSpec(CASES["I"], Plane.X_PX, (0.15, 0.2), (20, 20), t_max=100.0), "share_bounded", 0.2)
    answer = json.loads(out)
    assert code == 0
    assert (answer["low"], answer["high"]) == (wanted.low, wanted.high)
    assert len(answer["points"]) == wanted.value.size
    assert open_result(tmp_path / "where.nc").identical(wanted)
    table = (tmp_path / "where.csv").read_text()
    assert f"# estimate: {wanted.estimate!r}" in table


def test_a_parameter_is_found_at_an_energy_and_the_answer_is_a_sentence(run: Run) -> None:
    code, out, _ = run("where", "I", *SEARCH, "--against", "epsilon", "--energy", 0.2, "--low", 0.7, "--high", 1.2)
    spec = SweepSpec(
        CASES["I"], Plane.X_PX, np.array([0.7, 1.2]), (20, 20), t_max=100.0, measures=("shares",),
        along=ParameterAxis("epsilon", 0.7, 1.2, CASES["I"]), energy=0.2,
    )  # fmt: skip
    assert code == 0
    assert find_where(spec, "share_bounded", 0.2).describe() in out


def test_the_last_crossing_is_that_of_the_engine(run: Run) -> None:
    islands = ("--quantity", "islands", "--value", 0.5, "--resolution", 101, "--t-max", 1000, "--tolerance", 0.01)
    code, out, _ = run("where", "I", *islands, "--low", 0.24, "--high", 0.33, "--count", 5, "--last")
    spec = SweepSpec(CASES["I"], Plane.X_PX, np.linspace(0.24, 0.33, 5), (101, 101), t_max=1e3)
    assert code == 0
    assert find_where(spec, "islands", 0.5, tolerance=0.01, last=True).describe() in out
    assert find_where(spec, "islands", 0.5, tolerance=0.01).describe() not in out


def test_a_value_that_is_not_reached_is_an_invalid_request(run: Run) -> None:
    code, _, err = run("where", "I", *SEARCH, "--low", 0.2, "--high", 0.3)
    assert code == 2
    assert "value=0.2: is not reached between two values of h" in err
