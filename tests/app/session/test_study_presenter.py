"""Studies are computed at a click, stored, and clicks on their charts change the view."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.session.study_presenter import StudyPresenter
from app.state.view_state import ViewState
from engine import CASES, MapSpec, Plane, System, compute_map, find_lyapunov_orbits
from engine.jobs.manager import Jobs
from plots.studies.against import AGAINST, REFINED_VALUES, SWEPT_VALUES
from plots.studies.section import SECTION_STUDY
from plots.studies.study import Click, Study
from tests.app.session.session_lock import context_of
from tests.plots.studies.study_example import study_of_periods
from tests.waiting import SECONDS


class Session:
    """The parts of a session that a study needs."""

    def __init__(self, study: Study[Any], jobs: Jobs) -> None:
        self.changed = threading.Condition()
        self.state, self.jobs = ViewState(system=System("II"), energy=0.25, resolution=112, t_max=1e3), jobs
        self.context = context_of(self.state, jobs, self.changed, lambda *opened: setattr(self, "opened", opened))
        self.opened: Any = None
        self.present(study)

    def present(self, study: Study[Any]) -> None:
        """Make the presenter, as when its tab is first opened."""
        self.presenter = StudyPresenter(study, self.context)
        self.view = self.presenter.view

    def press(self) -> None:
        with self.changed:
            self.view.button.clicks += 1

    def wait_for(self, true: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(true, SECONDS), self.view.text.object

    def values(self) -> np.ndarray:
        assert self.view.shown is not None
        return np.asarray(next(iter(self.view.shown.columns().values())))

    def wait_for_values(self, count: int) -> None:
        self.wait_for(lambda: self.view.shown is not None and self.values().size >= count)


@pytest.fixture
def begin() -> Iterator[Callable[..., Session]]:
    sessions: list[Session] = []
    jobs = Jobs()

    def begin_session(study: Study[Any]) -> Session:
        sessions.append(Session(study, jobs))
        return sessions[-1]

    yield begin_session
    for session in sessions:
        session.context.jobs.close()


@pytest.fixture
def wide_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limit the work for each exponent of the curves, which widens the intervals."""
    monkeypatch.setattr("engine.measures.table.WORK", 1e7)


def test_a_study_of_one_entry_is_computed_stored_and_opens_the_clicked_energy(begin: Callable[..., Session]) -> None:
    session = begin(study_of_periods())
    assert not session.view.against.visible
    session.press()
    session.wait_for_values(9)
    assert not session.view.running
    found = session.context.results.studies["periods"]
    energy = float(found.h[-1])
    assert session.context.results.calls["periods"].arguments == (session.state.potential, tuple(found.h))
    assert found.longest[-1] == max(orbit.period for orbit in find_lyapunov_orbits(session.state.potential, energy))
    session.presenter.click(Click("", energy + 0.3, 5.0))
    assert (session.state.energy, session.state.plane) == (energy, Plane.X_PX)
    session.state.param.update(system=System("III"), energy=0.4)
    assert session.context.results.studies == session.context.results.calls == {}


def test_a_study_that_its_subject_does_not_allow_says_why(begin: Callable[..., Session]) -> None:
    def refuse(subject: Any, axis: str) -> Any:
        raise ValueError(f"h={subject.energy}: must be less")

    refused = begin(replace(study_of_periods(), job=refuse))
    refused.press()
    assert refused.view.text.object == "h=0.25: must be less"
    assert not refused.view.running


def test_a_quick_study_follows_each_map_from_its_first_frame_while_its_tab_is_open(begin: Callable[..., Session]) -> None:
    session = begin(SECTION_STUDY)
    assert not session.view.button.visible
    maps = {h: compute_map(MapSpec(CASES["II"], Plane.X_PX, h, (9, 9), t_max=1e3)) for h in (0.25, 0.15)}
    session.context.results.frame = maps[0.25]
    assert session.jobs.in_flight == 0
    session.state.analysis = "section"
    session.wait_for(lambda: session.view.shown is not None and not session.view.running)
    assert "at h = 0.25" in session.view.text.object
    with session.changed:
        session.state.energy = 0.15
        session.context.results.frame = replace(maps[0.15], complete=False)
    session.wait_for(lambda: "at h = 0.15" in session.view.text.object)
    session.wait_for(lambda: not session.view.running)
    # Later frames of the same map need no other computation.
    session.context.results.frame = maps[0.15]
    assert not session.view.running


def test_a_quick_study_that_is_made_while_its_tab_is_open_begins_with_the_present_map(begin: Callable[..., Session]) -> None:
    session = begin(study_of_periods())
    session.context.results.frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (9, 9), t_max=1e3))
    session.state.analysis = "section"
    session.present(SECTION_STUDY)
    session.wait_for(lambda: session.view.shown is not None and not session.view.running)
    assert "at h = 0.25" in session.view.text.object


@pytest.mark.usefixtures("wide_intervals")
def test_curves_arrive_one_by_one_and_stop_at_a_click_or_with_another_case(begin: Callable[..., Session]) -> None:
    session = begin(AGAINST)
    session.press()
    session.wait_for_values(2)
    assert session.view.running
    session.press()
    assert not session.view.running
    assert session.jobs.in_flight == 0
    assert f"of {SWEPT_VALUES + REFINED_VALUES}" in session.view.text.object
    energies = np.sort(session.values())
    session.presenter.click(Click("", float(energies[1]) + 1e-4, 0.0))
    assert (session.state.energy, session.state.plane) == (energies[1], Plane.X_PX)
    session.state.param.update(system=System("III"), energy=0.4)
    assert session.view.shown is None
    session.presenter.click(Click("", 0.3, 0.0))
    assert session.state.energy == 0.4


@pytest.mark.usefixtures("wide_intervals")
def test_a_click_opens_the_plane_of_the_shown_curves_after_another_sweep_was_stopped(begin: Callable[..., Session]) -> None:
    session = begin(AGAINST)
    session.press()
    session.wait_for_values(2)
    session.press()
    session.state.plane = Plane.X_Y
    with session.changed:
        session.press()
        session.press()
    value = float(np.max(session.values()))
    session.presenter.click(Click("", value, 0.0))
    assert (session.state.energy, session.state.plane) == (value, Plane.X_PX)


@pytest.mark.slow
@pytest.mark.usefixtures("wide_intervals")
def test_a_click_on_a_curve_against_a_parameter_opens_its_system(begin: Callable[..., Session]) -> None:
    session = begin(AGAINST)
    assert list(session.view.against.options) == ["h", "ω₁", "ω₂", "ε", "Ω"]
    session.view.against.value = "epsilon"
    session.press()
    session.wait_for_values(2)
    session.press()
    value = float(np.max(session.values()))
    session.presenter.click(Click("", value, 0.0))
    assert session.opened[0] == System("II", parameters={"epsilon": value})
    assert session.opened[1]["energy"] == 0.25
