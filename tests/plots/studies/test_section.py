"""The study of the section draws the returns of all orbits of an energy, and a click starts the orbit through a point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from app.views.components.charts import ChartView
from engine import CASES, Execution, Plane, System, integrate_orbit, read_section
from engine.jobs.job import run_job
from engine.results import Returns
from engine.systems.review.potential_review import review_system
from plots.pictures.charts import Series, Shape
from plots.pictures.palette import PAPER, value_colours
from plots.pictures.setting import NO_SETTINGS
from plots.studies.section import COLOURS, RETURNS, SECTION_STUDY
from plots.studies.study import Click, Subject

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
    (chart,) = SECTION_STUDY.charts(found, PAPER, NO_SETTINGS)
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
    changes = SECTION_STUDY.changes(SUBJECT, "", found, Click("", x + 1e-6, px - 1e-6))
    assert changes == {"plane": Plane.X_PX, "energy": 0.15, "start": (x, px)}


def coloured(found: Returns, choice: str) -> dict[str, Series]:
    """The series of the chart with one of the choices of colours, by colour."""
    return {one.colour: one for one in series_of(found, choice)}


def series_of(found: Returns, choice: str) -> Sequence[Series]:
    (chart,) = SECTION_STUDY.charts(found, PAPER, {COLOURS.name: choice})
    return chart.series


def places(*series: Series) -> set[tuple[float, float]]:
    return {place for one in series for place in zip(one.x.tolist(), one.y.tolist(), strict=True)}


@pytest.fixture(scope="module")
def escaping() -> Returns:
    """The returns at an energy at which some orbits escape."""
    result: Returns = run_job(SECTION_STUDY.job(replace(SUBJECT, energy=0.19), ""), Execution(), {})
    return result


def test_every_choice_of_colours_shows_the_same_points(escaping: Returns) -> None:
    expected = places(*SECTION_STUDY.charts(escaping, PAPER, NO_SETTINGS)[0].series)
    for choice in COLOURS.choices:
        assert places(*series_of(escaping, choice)) == expected


def test_points_have_the_colour_of_the_exit_of_their_orbit(escaping: Returns) -> None:
    series = coloured(escaping, "fate")
    assert series[PAPER.bounded].label == "not escaped"
    x, ordinate = escaping.spec.pixel_centres()
    starts = escaping.spec.start_states(*(grid.ravel() for grid in np.meshgrid(x, ordinate)))
    checked = 0
    for k in np.flatnonzero(escaping.fate.ravel() > 0):
        fate = integrate_orbit(CASES["II"], starts[k], 1e4).fate
        count = escaping.count.ravel()[k]
        points = escaping.spec.section.axes.points(escaping.states.reshape(RETURNS, -1, 4)[:count, k])
        assert {tuple(point) for point in points.tolist()} <= places(series[PAPER.channels[fate - 1]])
        checked += count > 0
    assert checked > 5


def test_dense_points_have_the_colours_of_the_upper_classes(found: Returns) -> None:
    series = coloured(found, "density")
    colours = value_colours(6)
    assert list(series) == [colour for colour in colours if colour in series]
    assert series[colours[0]].label == "1 point in a cell"
    nearest = []
    for colour in (colours[0], colours[4]):
        points = np.column_stack([series[colour].x, series[colour].y])
        others = np.array(sorted(places(*series.values())))
        distances = np.sort(np.hypot(*(points[:60, None] - others[None]).transpose(2, 0, 1)), axis=1)
        nearest.append(np.median(distances[:, 8]))
    assert nearest[1] < 0.3 * nearest[0]


def test_a_part_of_a_map_on_the_section_is_shown_larger() -> None:
    window = (-0.1, 0.3, -0.2, 0.2)
    on_section = replace(SUBJECT, plane=Plane.X_PX, window=window)
    found = run_job(SECTION_STUDY.job(on_section, ""), Execution(), {})
    (chart,) = SECTION_STUDY.charts(found, PAPER, NO_SETTINGS)
    assert chart.axis_limits == ((-0.1, 0.3), (-0.2, 0.2))


def test_an_energy_without_orbits_gives_no_chart(found: Returns) -> None:
    empty = replace(found, states=np.full_like(found.states, np.nan), time=np.full_like(found.time, np.nan))
    assert SECTION_STUDY.charts(empty, PAPER, NO_SETTINGS) == []


def test_another_section_has_its_own_axes_and_starts() -> None:
    section = read_section("x = 0, px > 0")
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=section), ""), Execution(), {})
    (chart,) = SECTION_STUDY.charts(found, PAPER, NO_SETTINGS)
    assert chart.frame.labels == ("y", "py")
    assert "upward crossings of x = 0" in SECTION_STUDY.sentence(found)
    y, py = found.points()[5][2].tolist()
    assert SECTION_STUDY.changes(SUBJECT, "", found, Click("", y, py)) == {"plane": Plane.Y_PY, "energy": 0.15, "start": (y, py)}


@pytest.mark.parametrize("text", ["y = 0 both", "angle = 30°", "x + y = 0.1 both", "px = 0 both", "apsis"])
def test_a_click_starts_the_orbit_of_the_point_in_every_direction(text: str) -> None:
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=read_section(text)), ""), Execution(), {})
    states = found.states[np.isfinite(found.time)][::97]
    (chart,) = SECTION_STUDY.charts(found, PAPER, NO_SETTINGS)
    assert "Click" in SECTION_STUDY.invitation(found)
    assert "Click" in chart.frame.text
    for state in states:
        changes = SECTION_STUDY.changes(SUBJECT, "", found, Click("", *found.spec.section.axes.points(state)))
        (start,) = changes["plane"].states(CASES["II"], 0.15, *np.array(changes["start"])[:, None])
        np.testing.assert_allclose(start, state, atol=1e-8)


def test_points_that_are_no_starts_of_a_slice_cannot_be_clicked() -> None:
    found = run_job(SECTION_STUDY.job(replace(SUBJECT, section=read_section("x + 0.3 px = 0")), ""), Execution(), {})
    assert found.count.any()
    (chart,) = SECTION_STUDY.charts(found, PAPER, NO_SETTINGS)
    assert "Click" not in SECTION_STUDY.invitation(found) + chart.frame.text
    assert SECTION_STUDY.changes(SUBJECT, "", found, Click("", 0.0, 0.0)) == {}
