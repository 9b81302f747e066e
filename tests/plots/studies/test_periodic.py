"""The studies of periodic orbits and families draw what was found, and a click opens it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.views.components.charts import ChartView
from engine import Execution, OrbitFamily, Plane, SpecialKind, System, continue_family, integrate_orbit
from engine.jobs.job import run_job
from engine.results import PeriodicOrbits
from engine.systems.review.potential_review import review_system
from plots.pictures.charts import Shape
from plots.pictures.palette import PAPER
from plots.pictures.periodic_marks import STABILITY_COLOURS
from plots.pictures.setting import NO_SETTINGS
from plots.studies.family import FAMILY_STUDY
from plots.studies.periodic import PERIODIC_STUDY, UP_TO
from plots.studies.study import Click, Subject

SYSTEM = System("III")
SUBJECT = Subject(SYSTEM, SYSTEM.potential, Plane.X_PX, 0.3, review_system(SYSTEM).energies, 1e3)
# A start near the straight orbit x = 0.
CHOSEN = replace(SUBJECT, state=(0.01, 0.0, 0.0, 0.77))


@pytest.fixture(scope="module")
def found() -> PeriodicOrbits:
    result: PeriodicOrbits = run_job(PERIODIC_STUDY.job(SUBJECT, ""), Execution(), {})
    return result


@pytest.fixture(scope="module")
def family() -> OrbitFamily:
    result: OrbitFamily = run_job(FAMILY_STUDY.job(CHOSEN, "h"), Execution(), {})
    return result


def test_stable_orbits_are_rings_and_unstable_ones_crosses(found: PeriodicOrbits) -> None:
    (chart,) = PERIODIC_STUDY.charts(found, PAPER, NO_SETTINGS)
    shapes = {one.colour: one.shape for one in chart.series}
    assert shapes == {
        colour: Shape.RINGS if kind.value == "stable" else Shape.CROSSES
        for kind, colour in STABILITY_COLOURS.items()
        if np.any(found.stability == kind)
    }
    assert sum(one.x.size for one in chart.series) == len(found.orbit)


def test_the_page_shows_each_return_with_its_note(found: PeriodicOrbits) -> None:
    (chart,) = PERIODIC_STUDY.charts(found, PAPER, NO_SETTINGS)
    view = ChartView(chart.frame)
    view.show(chart)
    data = view.points.data
    assert len(data["note"]) == len(found.orbit)
    assert set(data["marker"]) == {"circle", "x"}
    number = data["note"].index(next(note for note in data["note"] if "T = 6.28319" in note))
    assert (data["x"][number], data["y"][number]) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_the_number_of_returns_is_a_choice(found: PeriodicOrbits) -> None:
    (chart,) = PERIODIC_STUDY.charts(found, PAPER, {UP_TO.name: 1})
    assert sum(one.x.size for one in chart.series) == np.count_nonzero(found.returns == 1)


def test_a_click_on_a_return_starts_its_orbit(found: PeriodicOrbits) -> None:
    orbit = next(orbit for orbit in found if orbit.returns == 2)
    x, px = orbit.points[1].tolist()
    changes = PERIODIC_STUDY.changes(SUBJECT, "", found, Click("periodic", x + 1e-4, px))
    assert changes["start"] == pytest.approx((x, px), abs=1e-9)
    (start,) = SUBJECT.plane.states(SUBJECT.potential, 0.3, *np.array(changes["start"])[:, None])
    path = integrate_orbit(SUBJECT.potential, start, t_max=orbit.period)
    assert (path.x[-1], path.y[-1]) == pytest.approx((path.x[0], path.y[0]), abs=1e-6)


def test_a_family_needs_a_chosen_orbit() -> None:
    with pytest.raises(ValueError, match="Choose an orbit first"):
        FAMILY_STUDY.job(SUBJECT, "h")


def test_the_charts_of_a_family_mark_its_special_points(family: OrbitFamily) -> None:
    charts = {chart.frame.name: chart for chart in FAMILY_STUDY.charts(family, PAPER, NO_SETTINGS)}
    assert list(charts) == ["family_returns", "family_index", "family_period", "family_action"]
    (rings,) = [one for one in charts["family_index"].series if one.shape is Shape.RINGS]
    assert rings.notes[0].startswith("resonance 1:")
    assert rings.x.tolist() == [point.energy for point in family.special]


def test_stable_parts_of_a_curve_are_thick(family: OrbitFamily) -> None:
    chart = FAMILY_STUDY.charts(family, PAPER, NO_SETTINGS)[1]
    (end,) = [point.energy for point in family.special if point.kind is SpecialKind.BRANCHING]
    thick = [one for one in chart.series if one.shape is Shape.THICK]
    thin = [one for one in chart.series if one.shape is Shape.LINE]
    assert max(one.x.max() for one in thick) == pytest.approx(end, abs=1e-9)
    assert min(one.x.min() for one in thin) == pytest.approx(end, abs=1e-9)


def test_a_click_on_a_family_opens_the_member_of_that_energy(family: OrbitFamily) -> None:
    changes = FAMILY_STUDY.changes(CHOSEN, "h", family, Click("family_returns", 0.45, 0.0))
    assert abs(changes["energy"] - 0.45) <= np.abs(family.energy - 0.45).min()
    assert changes["start"] == pytest.approx((0.0, 0.0), abs=1e-9)


@pytest.fixture(scope="module")
def folded(family: OrbitFamily) -> OrbitFamily:
    number = [point.kind for point in family.special].index(SpecialKind.BRANCHING)
    return continue_family(family.switch(number)[0], (0.5, 0.7))


@pytest.mark.parametrize(
    ("chart", "name"), [("family_index", "stability_index"), ("family_period", "period"), ("family_action", "action")]
)
def test_a_click_opens_the_member_at_its_height_where_a_fold_has_two_of_one_energy(
    folded: OrbitFamily, chart: str, name: str
) -> None:
    assert len(folded.at(0.58)) > 1
    heights = getattr(folded, name)
    for k in np.flatnonzero(np.abs(heights) < 2.5 if chart == "family_index" else np.isfinite(heights))[::5]:
        changes = FAMILY_STUDY.changes(CHOSEN, "h", folded, Click(chart, float(folded.energy[k]), float(heights[k])))
        assert changes["energy"] == folded.energy[k]
        assert changes["start"] == pytest.approx(folded.points[k, 0], abs=1e-9)


def test_a_click_on_a_return_of_a_family_starts_the_member_at_this_return(found: PeriodicOrbits) -> None:
    orbit = next(orbit for orbit in found if np.ptp(orbit.points[:, 0]) > 0.1)
    family = continue_family(orbit, 0.31)
    assert np.argmax(np.ptp(family.points, axis=(0, 1))) == 0
    for number, (x, px) in enumerate(family.points[0]):
        changes = FAMILY_STUDY.changes(CHOSEN, "h", family, Click("family_returns", float(family.energy[0]), float(x)))
        assert changes["start"] == pytest.approx((x, px), abs=1e-9), number


@pytest.fixture(scope="module")
def along_epsilon() -> OrbitFamily:
    result: OrbitFamily = run_job(FAMILY_STUDY.job(CHOSEN, "epsilon"), Execution(), {})
    return result


def test_a_family_can_be_followed_along_a_parameter_of_the_system(along_epsilon: OrbitFamily) -> None:
    assert set(SYSTEM.parameter_names) < set(FAMILY_STUDY.axes(SYSTEM))
    assert (along_epsilon.value[0], along_epsilon.value[-1]) == (0.5, 2.0)
    charts = FAMILY_STUDY.charts(along_epsilon, PAPER, NO_SETTINGS)
    assert {chart.frame.labels[0] for chart in charts} == {"ε"}
    assert max(one.x.max() for one in charts[1].series) == 2.0
    assert "Touching at ε = " in FAMILY_STUDY.sentence(along_epsilon)


def test_a_click_on_a_family_along_a_parameter_opens_the_system_of_the_member(along_epsilon: OrbitFamily) -> None:
    changes = FAMILY_STUDY.changes(CHOSEN, "epsilon", along_epsilon, Click("family_returns", 1.4, 0.0))
    system = changes["system"]
    assert abs(system.value_of("epsilon") - 1.4) == np.abs(along_epsilon.value - 1.4).min()
    assert changes["energy"] == along_epsilon.energy[0]
    ((x, px),) = changes["starts"]
    (start,) = changes["plane"].states(system.potential, changes["energy"], np.array([x]), np.array([px]))
    path = integrate_orbit(system.potential, start, t_max=along_epsilon.period[0])
    assert (path.x[-1], path.y[-1]) == pytest.approx((path.x[0], path.y[0]), abs=1e-6)


def test_the_sentence_names_the_special_points(family: OrbitFamily) -> None:
    sentence = FAMILY_STUDY.sentence(family)
    assert "Touching at h = 0.43557688, branching at h = 0.58167974." in sentence
