"""Orbits of a session are integrated, judged and shown on the maps."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from app.session.orbit_presenter import ORBITS_REMOVED, OrbitPresenter
from app.state.view_state import ViewState
from app.views.maps.markers import Markers
from engine import Coordinate, ParameterAxis, Plane, Slice, System
from engine.jobs.manager import Jobs
from tests.app.map_actions import make_well
from tests.app.session.session_lock import context_of
from tests.waiting import SECONDS


class RecordingMarkers(Markers):
    """Counts the section points that are shown."""

    def __init__(self, state: ViewState) -> None:
        super().__init__(state)
        self.points: list[int] = []

    def show_sections(self, sections: Any) -> None:
        super().show_sections(sections)
        self.points = [len(section) for section in sections]


class Session:
    """The parts of a session that orbits need."""

    def __init__(self, plane: Slice) -> None:
        self.changed = threading.Condition()
        self.state = ViewState(system=System("I"), energy=0.19, t_max=1e3, plane=plane)
        self.marks, self.well = RecordingMarkers(self.state), make_well(self.state)
        self.opened: list[tuple[System, dict[str, Any]]] = []
        self.context = context_of(self.state, Jobs(), self.changed, lambda system, values: self.opened.append((system, values)))
        self.presenter = OrbitPresenter(self.context, self.marks, self.well, lambda x, ordinate: None)

    def has_paths(self) -> bool:
        sources = [each.data_source for each in self.well.plot.renderers]
        return any(source.name == "paths" and len(source.data["xs"]) for source in sources)

    def wait_for_paths(self) -> None:
        with self.changed:
            assert self.changed.wait_for(self.has_paths, SECONDS)


@pytest.fixture
def begin() -> Iterator[Callable[[Slice], Session]]:
    sessions: list[Session] = []

    def begin_session(plane: Slice) -> Session:
        sessions.append(Session(plane))
        return sessions[-1]

    yield begin_session
    for session in sessions:
        session.context.jobs.close()


@pytest.mark.parametrize(("plane", "on_section"), [(Plane.X_PX, True), (Plane.X_Y, False)])
def test_section_points_are_shown_on_their_plane_only(begin: Callable[[Slice], Session], plane: Plane, on_section: bool) -> None:
    session = begin(plane)
    session.state.add_start((-0.3, 0.0))
    session.wait_for_paths()
    assert [points > 0 for points in session.marks.points] == [on_section]


@pytest.mark.parametrize(
    ("plane", "start", "expected", "energy"),
    [
        (
            Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))),
            (0.1, 1.5),
            System("I", parameters={"epsilon": 1.5}),
            0.19,
        ),
        (Plane.X_H, (0.1, 0.25), System("I"), 0.25),
    ],
    ids=["parameter", "energy"],
)
def test_an_orbit_opens_the_section_of_its_system_at_its_energy(
    begin: Callable[[Slice], Session], plane: Slice, start: tuple[float, float], expected: System, energy: float
) -> None:
    session = begin(plane)
    session.state.add_start(start)
    session.wait_for_paths()
    session.presenter.controls.open_section.clicks += 1
    [(system, values)] = session.opened
    assert system == expected
    assert (values["plane"], values["energy"], values["starts"]) == (Plane.X_PX, energy, ((0.1, 0.0),))


def test_another_slice_leaves_out_orbits_without_a_place_on_it_and_says_so(begin: Callable[[Slice], Session]) -> None:
    session = begin(Plane.X_PX)
    session.state.param.update(starts=((-0.3, 0.1), (0.1, 0.0)))
    notice = session.context.notice.layout()
    session.state.show_slice(Plane.X_Y)
    assert session.state.starts == ((0.1, 0.0),)
    assert ORBITS_REMOVED in notice.object
    session.context.notice.clear()
    session.state.show_slice(Plane.X_PX)
    assert session.state.starts == ((0.1, 0.0),)
    assert notice.object == ""


def test_an_orbit_stays_where_it_meets_the_section_on_the_slice_of_the_section(begin: Callable[[Slice], Session]) -> None:
    session = begin(Plane.X_Y)
    session.state.add_start((0.1, 0.2))
    session.wait_for_paths()
    session.state.show_slice(Plane.X_PX)
    assert len(session.state.starts) == 1
    assert session.context.notice.layout().object == ""


def test_the_chosen_orbit_is_removed_and_the_others_stay(begin: Callable[[Slice], Session]) -> None:
    session = begin(Plane.X_PX)
    starts = ((-0.3, 0.0), (0.1, 0.0), (0.2, 0.1))
    session.state.param.update(starts=starts, chosen=1)
    session.presenter.controls.remove.clicks += 1
    assert session.state.starts == (starts[0], starts[2])
