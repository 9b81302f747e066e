"""The command ``study`` computes, prints and writes any study of the page."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from cli.commands import study as command
from engine import CASES, find_lyapunov_orbits
from tests.cli.conftest import Run
from tests.plots.studies.study_example import study_of_periods


@pytest.fixture(autouse=True)
def with_periods(monkeypatch: pytest.MonkeyPatch) -> None:
    """List the study of the example in docs/extending.md as well."""
    monkeypatch.setattr(command, "STUDIES", {**command.STUDIES, "periods": study_of_periods()})


def test_a_study_is_printed_and_written(run: Run, tmp_path: Path) -> None:
    code, out, err = run("study", "periods", "II", "--json", "--output", tmp_path / "found")
    assert (code, err) == (0, "")
    last = json.loads(out)["points"][-1]
    assert last["longest"] == max(orbit.period for orbit in find_lyapunov_orbits(CASES["II"], last["h"]))
    with (tmp_path / "found.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert float(rows[-1]["longest"]) == last["longest"]
    assert (tmp_path / "found.nc").exists()


def test_the_charts_of_a_study_are_drawn(run: Run, tmp_path: Path) -> None:
    _, out, _ = run("study", "periods", "II", "--output", tmp_path / "found.svg")
    assert "The periods of the Lyapunov orbits at 9 energies." in out
    # What a click does is a sentence for the page.
    assert "Click" not in out
    assert "Periods of the Lyapunov orbits" in (tmp_path / "found.svg").read_text()


def test_an_axis_that_a_study_does_not_have_is_refused(run: Run) -> None:
    code, _, err = run("study", "periods", "II", "--against", "epsilon")
    assert code == 2
    assert "against='epsilon': must be one of h" in err


def test_a_study_is_about_a_section(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(
        "study", "section", "HH", "--energy", "0.1", "--section", "x = 0, px > 0", "--output", tmp_path / "found.csv"
    )
    assert code == 0
    assert "upward crossings of x = 0 by" in out
    code, out, _ = run(
        *("study", "section", "HH", "--energy", "0.1", "--section-colours", "density", "--output", tmp_path / "part.png"),
    )
    assert code == 0
    assert (tmp_path / "part.png").read_bytes().startswith(b"\x89PNG")
    code, _, err = run("study", "section", "HH", "--section", "somewhere")
    assert code == 2
    assert "must be a section such as" in err


def test_a_family_begins_at_a_start_on_the_plane_or_at_a_state(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("study", "family", "III", "--energy", "0.3", "--start", "0", "0", "--output", tmp_path / "family.csv")
    assert code == 0
    assert "branching at h = 0.58167974" in out
    with (tmp_path / "family.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert {row["period"][:8] for row in rows} == {"6.283185"}
    state = ("--state", "0", "0", "0", "0.7")
    assert run("study", "family", "III", *state, "--output", tmp_path / "family.csv")[0] == 0


def test_a_family_is_followed_along_a_parameter(run: Run, tmp_path: Path) -> None:
    start = ("--energy", "0.3", "--start", "0", "0")
    code, out, _ = run("study", "family", "III", *start, "--against", "epsilon", "--output", tmp_path / "family.csv")
    assert code == 0
    assert "Touching at ε = 1.4519229, branching at ε = 1.9389325." in out
    with (tmp_path / "family.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert (float(rows[0]["value"]), float(rows[-1]["value"])) == (0.5, 2.0)
    assert {row["energy"] for row in rows} == {rows[0]["energy"]}


def test_a_family_without_a_start_is_refused(run: Run) -> None:
    code, _, err = run("study", "family", "III", "--energy", "0.3")
    assert code == 2
    assert "the study family needs --start X ORDINATE or --state X Y PX PY" in err
    code, _, err = run("study", "section", "III", "--start", "0", "0")
    assert code == 2
    assert "the study section does not depend on --start" in err
