"""Orbits of a session on the maps."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from app.session.orbit_presenter import OrbitPresenter
from app.state.view_state import ViewState
from app.views.maps.markers import Markers
from app.views.maps.well import WellView
from engine import Coordinate, ParameterAxis, Plane, Slice, System
from engine.jobs.manager import Jobs


class RecordingMarkers(Markers):
    """Counts the section points that are shown."""

    def __init__(self) -> None:
        super().__init__()
        self.points: list[int] = []

    def show_sections(self, sections: Any) -> None:
        super().show_sections(sections)
        self.points = [len(section) for section in sections]


class Session:
    """The parts of a session that orbits need."""

    def __init__(self, plane: Slice) -> None:
        self.changed = threading.Condition()
        self.state, self.marks = ViewState(case="I", energy=0.19, t_max=1e3, plane=plane), RecordingMarkers()
        self.drawn = False
        self.opened: list[tuple[System, dict[str, Any]]] = []
        self.presenter = OrbitPresenter(
            self.state,
            Jobs(),
            self.marks,
            WellView(),
            lambda x, ordinate: None,
            lambda orbits: None,
            lambda text: None,
            lambda system, values: self.opened.append((system, values)),
            self.locked,
            self.locked,
        )

    def locked(self, function: Callable[..., None]) -> Callable[..., None]:
        def call(*arguments: Any) -> None:
            with self.changed:
                function(*arguments)
                self.drawn = any(orbit.drawing is not None for orbit in self.presenter._shown)
                self.changed.notify_all()

        return call


@pytest.fixture
def begin() -> Iterator[Callable[[Slice], Session]]:
    sessions: list[Session] = []

    def begin_session(plane: Slice) -> Session:
        sessions.append(Session(plane))
        return sessions[-1]

    yield begin_session
    for session in sessions:
        session.presenter.close()


@pytest.mark.parametrize(("plane", "on_section"), [(Plane.X_PX, True), (Plane.X_Y, False)])
def test_section_points_are_shown_on_their_plane_only(begin: Callable[[Slice], Session], plane: Plane, on_section: bool) -> None:
    session = begin(plane)
    session.state.add_start((-0.3, 0.0))
    with session.changed:
        assert session.changed.wait_for(lambda: session.drawn, 60.0)
        assert [points > 0 for points in session.marks.points] == [on_section]


def test_an_orbit_along_a_parameter_opens_the_section_of_its_system(begin: Callable[[Slice], Session]) -> None:
    session = begin(Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))))
    session.state.add_start((0.1, 1.5))
    session.presenter._open_plane()
    [(system, values)] = session.opened
    assert system == System("I", parameters={"epsilon": 1.5})
    assert (values["plane"], values["energy"], values["starts"]) == (Plane.X_PX, 0.19, ((0.1, 0.0),))


def test_an_orbit_on_h_opens_the_section_at_its_energy(begin: Callable[[Slice], Session]) -> None:
    session = begin(Plane.X_H)
    session.state.add_start((0.1, 0.25))
    session.presenter._open_plane()
    [(system, values)] = session.opened
    assert (system, values["energy"], values["starts"]) == (System("I"), 0.25, ((0.1, 0.0),))
