"""The chosen orbits come, go and are refused; their twins and their distance with them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import pytest

from app.job_clients.indicators_requests import IndicatorsRequests
from app.job_clients.orbit_requests import ChosenOrbit, OrbitRequests
from app.job_clients.separation_requests import SeparationRequests
from app.job_clients.twin_requests import TwinRequests
from app.state.view_state import ViewState
from engine import IndicatorVerdict, Jobs, Plane, Separation, Verdict, integrate_orbit


class Desk:
    """Hears what an explorer's views would be told."""

    def __init__(self) -> None:
        self.orbits: tuple[ChosenOrbit, ...] = ()
        self.said: list[str] = []
        self.separations: list[tuple[tuple[int, int] | None, Separation | None]] = []
        self.verdicts: list[tuple[IndicatorVerdict, ...]] = []
        self.changed = threading.Condition()

    def hear(self, act: Callable[[], None]) -> None:
        with self.changed:
            act()
            self.changed.notify_all()

    def show(self, orbits: tuple[ChosenOrbit, ...]) -> None:
        self.hear(lambda: setattr(self, "orbits", orbits))

    def say(self, sentence: str) -> None:
        self.hear(lambda: self.said.append(sentence))

    def show_separation(self, pair: tuple[int, int] | None, separation: Separation | None) -> None:
        self.hear(lambda: self.separations.append((pair, separation)))

    def show_verdicts(self, verdicts: Sequence[IndicatorVerdict]) -> None:
        self.hear(lambda: self.verdicts.append(tuple(verdicts)))

    def wait_for(self, true: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(true, 30.0), (self.orbits, self.said)

    def all_here(self, count: int) -> bool:
        return len(self.orbits) == count and all(one.orbit is not None or one.problem for one in self.orbits)


Session = tuple[ViewState, OrbitRequests, Desk, Jobs]


def unlocked(function: Callable[..., None]) -> Callable[..., None]:
    return function


@pytest.fixture
def session() -> Iterator[Session]:
    state, desk, jobs = ViewState(case="I", energy=0.25, t_max=1e3), Desk(), Jobs()
    requests = OrbitRequests(state, jobs, desk.show, unlocked)
    yield state, requests, desk, jobs
    requests.close()


def test_the_orbit_of_a_start_is_the_engine_s(session: Session) -> None:
    state, _, desk, _ = session
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    spec = state.orbit_spec((0.1, 0.05))
    assert spec is not None
    expected = integrate_orbit(spec.potential, spec.state, 1e3)
    orbit = desk.orbits[0].orbit
    assert orbit is not None
    assert (orbit.fate, orbit.escape_time) == (expected.fate, expected.escape_time)


def test_several_orbits_keep_their_places(session: Session) -> None:
    state, _, desk, _ = session
    for x in (0.1, 0.2, 0.3):
        state.add_start((x, 0.0))
    desk.wait_for(lambda: desk.all_here(3))
    assert [one.orbit.x[0] for one in desk.orbits if one.orbit is not None] == [0.1, 0.2, 0.3]


def test_a_forbidden_start_is_refused_in_words(session: Session) -> None:
    state, _, desk, _ = session
    state.add_start((0.0, 5.0))
    desk.wait_for(lambda: desk.all_here(1))
    assert "Forbidden" in desk.orbits[0].problem


def test_a_removed_orbit_is_given_up(session: Session) -> None:
    state, _, desk, jobs = session
    state.param.update(case="III", energy=0.25, t_max=1e6)
    state.add_start((0.0, 0.1))
    state.remove_start(0)
    assert desk.orbits == ()
    assert jobs.in_flight == 0


def test_orbits_follow_the_energy(session: Session) -> None:
    state, _, desk, _ = session
    state.add_start((0.1, 0.05))
    state.energy = 0.3
    desk.wait_for(lambda: desk.all_here(1) and desk.orbits[0].orbit.energy == pytest.approx(0.3))  # type: ignore[union-attr]


def test_an_orbit_that_is_kept_is_there_at_once(session: Session) -> None:
    state, _, desk, _ = session
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    state.remove_start(0)
    state.add_start((0.1, 0.05))
    assert desk.all_here(1)


def test_a_session_that_ends_leaves_no_job_behind(session: Session) -> None:
    state, requests, _, jobs = session
    state.param.update(case="III", energy=0.25, t_max=1e6)
    state.add_start((0.0, 0.1))
    requests.close()
    assert jobs.in_flight == 0


def test_the_twin_leaves_elsewhere_and_is_looked_at(session: Session) -> None:
    state, _, desk, jobs = session
    twin = TwinRequests(state, jobs, desk.say, unlocked)
    state.add_start((0.1, 0.05))
    twin.search()
    desk.wait_for(lambda: desk.all_here(2))
    first, second = (one.orbit for one in desk.orbits)
    assert first is not None
    assert second is not None
    assert first.fate != second.fate
    assert state.chosen == 1
    assert "twin starts" in desk.said[-1]


def test_without_a_start_there_is_no_twin(session: Session) -> None:
    state, _, desk, jobs = session
    TwinRequests(state, jobs, desk.say, unlocked).search()
    assert desk.said == ["Click a start first: its twin is the nearest start that leaves elsewhere."]


def test_a_twin_that_comes_too_late_is_not_added(session: Session) -> None:
    state, _, desk, jobs = session
    twin = TwinRequests(state, jobs, desk.say, unlocked)
    state.add_start((0.1, 0.05))
    twin.search()
    twin.close()
    desk.wait_for(lambda: jobs.in_flight == 0 or desk.all_here(1))
    assert len(state.starts) == 1


def test_where_nothing_leaves_that_is_said(session: Session) -> None:
    state, _, desk, jobs = session
    state.energy = 0.1
    state.add_start((0.1, 0.05))
    TwinRequests(state, jobs, desk.say, unlocked).search()
    desk.wait_for(lambda: "No start near this one leaves elsewhere." in desk.said)


def test_the_last_two_orbits_are_compared(session: Session) -> None:
    state, _, desk, jobs = session
    separation = SeparationRequests(state, jobs, desk.show_separation, desk.say, unlocked)
    for x in (0.1, 0.1001):
        state.add_start((x, 0.05))
    desk.wait_for(lambda: desk.all_here(2))
    separation.follow(desk.orbits)
    desk.wait_for(lambda: bool(desk.separations) and desk.separations[-1][1] is not None)
    pair, found = desk.separations[-1]
    assert pair == (0, 1)
    assert found is not None
    assert found.distance[0] == pytest.approx(np.hypot(1e-4, 0.0), rel=0.1)


def test_one_orbit_has_no_distance(session: Session) -> None:
    state, _, desk, jobs = session
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    SeparationRequests(state, jobs, desk.show_separation, desk.say, unlocked).follow(desk.orbits)
    assert desk.separations == [(None, None)]


@pytest.mark.parametrize(("energy", "conclusion"), [(0.05, Verdict.REGULAR), (0.1, Verdict.CHAOTIC)])
def test_a_bounded_orbit_is_judged_by_three_indicators(session: Session, energy: float, conclusion: Verdict) -> None:
    state, _, desk, jobs = session
    indicators = IndicatorsRequests(state, jobs, desk.show_verdicts, desk.say, unlocked)
    state.param.update(energy=energy, t_max=1e4)
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    indicators.follow(desk.orbits)
    desk.wait_for(lambda: len(desk.verdicts) == 2)
    assert [len(verdicts) for verdicts in desk.verdicts] == [2, 3]
    assert {verdict.conclusion for verdict in desk.verdicts[-1]} == {conclusion}


def test_an_escaping_orbit_gets_no_verdict(session: Session) -> None:
    state, _, desk, jobs = session
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    IndicatorsRequests(state, jobs, desk.show_verdicts, desk.say, unlocked).follow(desk.orbits)
    assert [verdict.conclusion for verdict in desk.verdicts[-1]] == [None, None]
    assert jobs.in_flight == 0


def test_an_orbit_is_judged_once(session: Session) -> None:
    state, _, desk, jobs = session
    state.add_start((0.1, 0.05))
    desk.wait_for(lambda: desk.all_here(1))
    indicators = IndicatorsRequests(state, jobs, desk.show_verdicts, desk.say, unlocked)
    for _ in range(2):
        indicators.follow(desk.orbits)
    assert len(desk.verdicts) == 1


def test_without_an_orbit_there_is_no_verdict(session: Session) -> None:
    state, _, desk, jobs = session
    IndicatorsRequests(state, jobs, desk.show_verdicts, desk.say, unlocked).follow(())
    assert desk.verdicts == [()]


def test_on_the_energy_plane_each_start_has_its_own_energy(session: Session) -> None:
    state, _, desk, _ = session
    state.param.update(plane=Plane.X_H)
    for h in (0.2, 0.3):
        state.add_start((0.1, h))
    desk.wait_for(lambda: desk.all_here(2))
    assert [one.orbit.energy for one in desk.orbits if one.orbit] == pytest.approx([0.2, 0.3])
