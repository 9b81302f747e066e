"""The study of the section draws the returns of all orbits of an energy, and a click starts the orbit through a point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.views.components.charts import ChartView
from engine import CASES, Execution, Plane, System, read_section
from engine.jobs.job import run_job
from engine.results import Returns
from engine.systems.review.potential_review import review_system
from plots.pictures.charts import Shape
from plots.pictures.palette import PAPER
from plots.studies.section import RETURNS, SECTION_STUDY
from plots.studies.study import Subject

SYSTEM = System("II")
SUBJECT = Subject(SYSTEM, SYSTEM.potential, Plane.X_Y, 0.15, review_system(SYSTEM).energies, 1e4)


@pytest.fixture(scope="module")
def found() -> Returns:
    result: Returns = run_job(SECTION_STUDY.job(SUBJECT, ""), Execution(), {})
    return result


def test_bounded_orbits_have_all_their_returns_at_the_energy_of_the_view(found: Returns) -> None:
    assert SUBJECT.energy < CASES["II"].escape_energy
    assert set(np.unique(found.count)) == {0, RETURNS}
    assert found.spec.plane is Plane.X_PX
    assert "at h = 0.15" in SECTION_STUDY.sentence(found)


def test_every_return_is_a_dot_of_the_page_and_inside_the_limiting_curve(found: Returns) -> None:
    (chart,) = SECTION_STUDY.charts(found, PAPER)
    assert {one.shape for one in chart.series} == {Shape.DOTS}
    view = ChartView(chart.frame)
    view.show(chart)
    assert view.dots.data["x"].size == found.count.sum()
    assert len(view.dots.data["colour"]) == view.dots.data["x"].size
    assert view.points.data["x"] == []
    x, px = (np.concatenate([getattr(one, axis) for one in chart.series]) for axis in "xy")
    assert np.all(0.5 * px**2 + CASES["II"].value(x, np.zeros_like(x)) <= 0.15)


def test_a_click_starts_the_orbit_through_the_point_on_the_section(found: Returns) -> None:
    x, px = found.points()[7][3].tolist()
    changes = SECTION_STUDY.changes(SUBJECT, "", found, x + 1e-6, px - 1e-6)
    assert changes == {"plane": Plane.X_PX, "energy": 0.15, "start": (x, px)}


def test_an_energy_without_orbits_gives_no_chart(found: Returns) -> None:
    empty = Returns(found.spec, np.full_like(found.states, np.nan), np.full_like(found.time, np.nan))
    assert SECTION_STUDY.charts(empty, PAPER) == []


def test_another_section_has_its_own_axes_and_starts() -> None:
    section = read_section("x = 0, px > 0")
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=section), ""), Execution(), {})
    (chart,) = SECTION_STUDY.charts(found, PAPER)
    assert chart.frame.labels == ("y", "py")
    assert "upward crossings of x = 0" in SECTION_STUDY.sentence(found)
    y, py = found.points()[5][2].tolist()
    assert SECTION_STUDY.changes(SUBJECT, "", found, y, py) == {"plane": Plane.Y_PY, "energy": 0.15, "start": (y, py)}


@pytest.mark.parametrize("text", ["y = 0 both", "angle = 30°", "x + y = 0.1 both", "px = 0 both", "apsis"])
def test_a_click_starts_the_orbit_of_the_point_in_every_direction(text: str) -> None:
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=read_section(text)), ""), Execution(), {})
    states = found.states[np.isfinite(found.time)][::97]
    (chart,) = SECTION_STUDY.charts(found, PAPER)
    assert "Click" in SECTION_STUDY.sentence(found)
    assert "Click" in chart.frame.text
    for state in states:
        changes = SECTION_STUDY.changes(SUBJECT, "", found, *found.spec.section.axes.points(state))
        (start,) = changes["plane"].states(CASES["II"], 0.15, *np.array(changes["start"])[:, None])
        np.testing.assert_allclose(start, state, atol=1e-8)


def test_points_that_are_no_starts_of_a_slice_cannot_be_clicked() -> None:
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=read_section("x + 0.3 px = 0")), ""), Execution(), {})
    assert found.count.any()
    (chart,) = SECTION_STUDY.charts(found, PAPER)
    assert "Click" not in SECTION_STUDY.sentence(found) + chart.frame.text
    assert SECTION_STUDY.changes(SUBJECT, "", found, 0.0, 0.0) == {}
