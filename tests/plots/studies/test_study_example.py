"""The study of the example in docs/extending.md has a table and a figure, as every study of the page."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import engine
from engine import CASES, Execution, Plane, System, find_lyapunov_orbits, open_result
from engine.jobs.job import run_job
from engine.systems.review.potential_review import review_system
from plots.pictures.palette import PAPER
from plots.pictures.setting import NO_SETTINGS
from plots.printed.figure_files import study_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.studies.study import Click, Study, Subject
from plots.studies.table import STUDIES
from plots.texts.exports import table_csv
from tests.plots.studies.study_example import study_of_periods

SYSTEM = System("II")
SUBJECT = Subject(SYSTEM, SYSTEM.potential, Plane.X_PX, 0.2, review_system(SYSTEM).energies, 1e3, state=(0.1, 0.0, 0.0, 0.4))


@pytest.mark.parametrize("study", [*STUDIES.values(), study_of_periods()], ids=lambda study: study.name)
def test_every_chart_of_a_study_says_how_to_read_it(study: Study[Any]) -> None:
    assert study.frames
    for frame in study.frames:
        assert len(frame.help) > 20
        assert "@" in frame.text or "$" in frame.text


@pytest.mark.parametrize("study", STUDIES.values(), ids=lambda study: study.name)
def test_a_script_can_call_the_function_of_every_study(study: Study[Any]) -> None:
    function = study.call(study.job(SUBJECT, next(iter(study.axes(SYSTEM)), ""))).function
    assert getattr(engine, function.__name__) is function


def test_the_study_of_the_example_has_a_table_a_figure_and_a_file(tmp_path: Path) -> None:
    study = study_of_periods()
    found = run_job(study.job(SUBJECT, "h"), Execution(), {})
    (chart,) = study.charts(found, PAPER, NO_SETTINGS)
    assert [one.label for one in chart.series] == ["shortest", "longest"]
    rows = list(csv.DictReader(line for line in table_csv(found).splitlines() if not line.startswith("#")))
    energy = float(rows[-1]["h"])
    assert energy > CASES["II"].escape_energy
    assert float(rows[-1]["shortest"]) == min(orbit.period for orbit in find_lyapunov_orbits(CASES["II"], energy))
    assert np.isnan(float(rows[0]["longest"]))
    assert study_figure_bytes(study, found, NO_SETTINGS, FigureFormat.PNG, FigureStyle()).startswith(b"\x89PNG")
    found.save(tmp_path / "periods.nc")
    np.testing.assert_array_equal(open_result(tmp_path / "periods.nc").longest, found.longest)


def test_a_click_beside_the_curves_opens_the_nearest_energy() -> None:
    study = study_of_periods()
    found = run_job(study.job(SUBJECT, "h"), Execution(), {})
    changes = study.changes(SUBJECT, "h", found, Click("periods", float(found.h[3]) + 1e-4, 1.0))
    assert changes == {"energy": float(found.h[3]), "plane": Plane.X_PX}
