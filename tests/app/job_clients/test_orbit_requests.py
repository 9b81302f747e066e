"""Orbits, their digits, neighbours and separations are requested, and late results are dropped."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from app.job_clients.chosen_orbit_requests import NeighbourRequests, PeriodicOrbitRequests, SeparationRequests
from app.job_clients.orbit_requests import OrbitRequests, StartOrbit
from app.state.view_state import ViewState
from engine import Plane, System, find_periodic_orbit, integrate_orbit, read_section
from engine.jobs.client import JobClient
from engine.jobs.manager import Jobs
from engine.results import Separation
from plots.links.map_view import Start
from tests.app.session.session_lock import context_of
from tests.engine.jobs.inbox import wait_until_idle
from tests.waiting import SECONDS


class Recorder:
    """Records calls to the views."""

    def __init__(self) -> None:
        self.orbits: tuple[StartOrbit, ...] = ()
        self.messages: list[str] = []
        self.separations: list[tuple[tuple[int, int] | None, Separation | None]] = []
        self.neighbours: list[tuple[str, Start | None]] = []
        self.changed = threading.Condition()

    def record(self, act: Callable[[], None]) -> None:
        with self.changed:
            act()
            self.changed.notify_all()

    def show(self, orbits: tuple[StartOrbit, ...]) -> None:
        self.record(lambda: setattr(self, "orbits", orbits))

    def notify(self, sentence: str) -> None:
        self.record(lambda: self.messages.append(sentence))

    def show_separation(self, pair: tuple[int, int] | None, separation: Separation | None) -> None:
        self.record(lambda: self.separations.append((pair, separation)))

    def show_neighbour(self, sentence: str, neighbour: Start | None) -> None:
        self.record(lambda: self.neighbours.append((sentence, neighbour)))

    def wait_for(self, true: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(true, SECONDS), (self.orbits, self.messages)

    def all_computed(self, count: int) -> bool:
        return len(self.orbits) == count and all(one.orbit is not None or one.problem for one in self.orbits)


Session = tuple[ViewState, OrbitRequests, Recorder, Jobs]


def unlocked(function: Callable[..., None]) -> Callable[..., None]:
    return function


@pytest.fixture
def session() -> Iterator[Session]:
    state, recorder, jobs = ViewState(system=System("I"), energy=0.25, t_max=1e3), Recorder(), Jobs()
    client = JobClient(jobs)
    requests = OrbitRequests(state, client, recorder.show, recorder.notify, unlocked)
    yield state, requests, recorder, jobs
    client.close()


def test_a_start_gets_its_orbit(session: Session) -> None:
    state, _, recorder, _ = session
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    job = state.orbit_job((0.1, 0.05))
    assert job is not None
    expected = integrate_orbit(*job.arguments)
    orbit = recorder.orbits[0].orbit
    assert orbit is not None
    assert (orbit.fate, orbit.escape_time) == (expected.fate, expected.escape_time)


def test_a_forbidden_start_gets_a_message(session: Session) -> None:
    state, _, recorder, _ = session
    state.add_start((0.0, 5.0))
    recorder.wait_for(lambda: recorder.all_computed(1))
    assert "Forbidden" in recorder.orbits[0].problem


def test_the_request_of_a_removed_start_is_cancelled(session: Session) -> None:
    state, _, recorder, jobs = session
    state.param.update(system=System("III"), energy=0.25, t_max=1e6)
    state.add_start((0.0, 0.1))
    state.remove_start(0)
    assert recorder.orbits == ()
    assert jobs.in_flight == 0


def test_a_cached_orbit_is_delivered_at_once_and_follows_the_energy(session: Session) -> None:
    state, _, recorder, _ = session
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    state.remove_start(0)
    state.add_start((0.1, 0.05))
    assert recorder.all_computed(1)
    state.energy = 0.3
    recorder.wait_for(lambda: recorder.all_computed(1) and recorder.orbits[0].orbit.energy == pytest.approx(0.3))  # type: ignore[union-attr]


def test_the_neighbour_of_the_chosen_start_ends_elsewhere(session: Session) -> None:
    state, _, recorder, jobs = session
    neighbours = NeighbourRequests(state, jobs, recorder.show_neighbour, unlocked)
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    neighbours.follow(recorder.orbits)
    recorder.wait_for(lambda: recorder.neighbours[-1][1] is not None)
    sentence, neighbour = recorder.neighbours[-1]
    assert neighbour is not None
    state.add_start(neighbour)
    recorder.wait_for(lambda: recorder.all_computed(2))
    first, second = (one.orbit for one in recorder.orbits)
    assert first is not None
    assert second is not None
    assert first.fate != second.fate
    assert sentence.endswith(f"away {second.outcomes[second.fate - 1].present}.")


def test_no_neighbour_is_searched_while_the_orbit_is_not_known(session: Session) -> None:
    state, _, recorder, jobs = session
    neighbours = NeighbourRequests(state, jobs, recorder.show_neighbour, unlocked)
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    neighbours.follow([StartOrbit(state.starts[0])])
    wait_until_idle(jobs)
    assert recorder.neighbours == [("", None)]


def test_a_start_without_a_neighbour_that_leaves_gets_a_sentence(session: Session) -> None:
    state, _, recorder, jobs = session
    neighbours = NeighbourRequests(state, jobs, recorder.show_neighbour, unlocked)
    state.energy = 0.1
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    neighbours.follow(recorder.orbits)
    recorder.wait_for(lambda: ("No start that ends elsewhere was found near this one.", None) in recorder.neighbours)


def test_the_last_two_orbits_are_compared(session: Session) -> None:
    state, _, recorder, jobs = session
    separation = SeparationRequests(state, jobs, recorder.show_separation, recorder.notify, unlocked)
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    separation.follow(recorder.orbits)
    assert recorder.separations == [(None, None)]
    state.add_start((0.1001, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(2))
    separation.follow(recorder.orbits)
    recorder.wait_for(lambda: bool(recorder.separations) and recorder.separations[-1][1] is not None)
    pair, found = recorder.separations[-1]
    assert pair == (0, 1)
    assert found is not None
    assert found.distance[0] == pytest.approx(np.hypot(1e-4, 0.0), rel=0.1)


def test_the_chosen_orbit_is_compared_with_the_one_that_was_chosen_before(session: Session) -> None:
    state, _, recorder, jobs = session
    separation = SeparationRequests(state, jobs, recorder.show_separation, recorder.notify, unlocked)
    for x in (0.1, 0.1001, 0.1002):
        state.add_start((x, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(3))
    state.chosen = 0
    state.chosen = 2
    separation.follow(recorder.orbits)
    recorder.wait_for(lambda: bool(recorder.separations) and recorder.separations[-1][1] is not None)
    assert recorder.separations[-1][0] == (0, 2)


def test_all_bounded_orbits_get_their_digits_as_evidence(session: Session) -> None:
    state, requests, recorder, jobs = session
    state.param.update(energy=0.14, t_max=1e4)
    for x in (-0.3, -0.305):
        state.add_start((x, 0.0))
    recorder.wait_for(lambda: len(recorder.orbits) == 2 and all(one.digits is not None for one in recorder.orbits))
    assert all("and probably for ever (evidence: its averages converge as on a" in one.describe() for one in recorder.orbits)
    requests.follow()
    assert all(one.digits is not None for one in recorder.orbits)
    assert jobs.in_flight == 0


def test_an_orbit_keeps_its_verdict_when_another_start_is_added(session: Session) -> None:
    state, _, recorder, _ = session
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    verdict = recorder.orbits[0].verdict
    state.add_start((0.1, 0.06))
    recorder.wait_for(lambda: recorder.all_computed(2))
    assert recorder.orbits[0].verdict is verdict


def test_a_bounded_orbit_arrives_with_the_digits_of_its_halves(session: Session) -> None:
    state, _, recorder, _ = session
    state.param.update(energy=0.14, t_max=1e3)
    state.add_start((-0.3, 0.0))
    recorder.wait_for(lambda: recorder.all_computed(1))
    assert "digits_of_halves" in vars(recorder.orbits[0].orbit)


def test_an_escaping_orbit_gets_no_digits(session: Session) -> None:
    state, _, recorder, jobs = session
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    assert recorder.orbits[0].digits is None
    assert jobs.in_flight == 0


def test_the_request_for_the_digits_of_a_removed_start_is_cancelled(session: Session) -> None:
    state, _, recorder, jobs = session
    state.param.update(energy=0.1, t_max=1e4)
    state.add_start((0.1, 0.05))
    recorder.wait_for(lambda: recorder.all_computed(1))
    state.remove_start(0)
    assert jobs.in_flight == 0


def begin_periodic_search(session: Session) -> PeriodicOrbitRequests:
    state, requests, recorder, jobs = session
    state.param.update(energy=0.14)
    change = context_of(state, jobs, recorder.changed).change
    return PeriodicOrbitRequests(state, jobs, recorder.notify, unlocked, change, requests.name_periodic)


def test_the_nearest_periodic_orbit_is_added_and_named_while_its_energy_stays(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.add_start((-0.3, 0.02))
    search.search()
    recorder.wait_for(lambda: recorder.all_computed(2) and recorder.orbits[1].periodic is not None)
    expected = find_periodic_orbit(state.potential, state.start_state((-0.3, 0.02)), t_max=1e3)
    assert state.chosen == 1
    assert state.starts[1] == pytest.approx(tuple(expected.points[0]), abs=1e-9)
    assert recorder.orbits[1].headline() == expected.describe()
    assert recorder.orbits[1].summarize() == "periodic, stable"
    assert recorder.orbits[0].periodic is None
    state.energy = 0.15
    assert [one.periodic for one in recorder.orbits] == [None, None]
    state.param.update(energy=0.14, t_max=1e2)
    assert recorder.orbits[1].headline() == expected.describe()


def test_a_start_on_a_periodic_orbit_is_kept(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.add_start((-0.3, 0.02))
    search.search()
    recorder.wait_for(lambda: recorder.all_computed(2) and recorder.orbits[1].periodic is not None)
    moved = state.starts[1][0] + 1e-12, state.starts[1][1]
    state.param.update(starts=(moved,), chosen=0)
    search.search()
    recorder.wait_for(lambda: recorder.all_computed(1) and recorder.orbits[0].periodic is not None)
    assert state.starts == (moved,)


def test_a_periodic_orbit_is_shown_on_the_slice_of_its_section(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.plane = Plane.X_Y
    state.add_start((-0.3, 0.0))
    search.search()
    recorder.wait_for(lambda: recorder.all_computed(1) and recorder.orbits[0].periodic is not None)
    assert state.plane == Plane.X_PX
    assert state.energy == 0.14


def test_a_periodic_orbit_that_no_slice_shows_is_described(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.section = read_section("y + px = 0")
    state.add_start((-0.3, 0.02))
    search.search()
    recorder.wait_for(lambda: "no slice contains its start" in recorder.messages[-1])
    assert recorder.messages[-1].startswith("Periodic orbit, ")
    assert len(state.starts) == 1


def test_a_search_without_periodic_orbit_says_why(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.energy = 0.3
    state.add_start((0.26, 0.39))
    search.search()
    recorder.wait_for(lambda: "no periodic orbit: the orbit of the start does not return" in recorder.messages[-1])


@pytest.mark.parametrize("changes", [{"energy": 0.02}, {"starts": ()}])
def test_nothing_is_searched_from_a_start_that_is_no_orbit_in_the_view(session: Session, changes: dict[str, object]) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.add_start((-0.3, 0.02))
    recorder.wait_for(lambda: recorder.all_computed(1))
    state.param.update(**changes)
    search.search()
    assert not any("Searching" in message for message in recorder.messages)


def test_the_path_of_an_unstable_periodic_orbit_is_explained(session: Session) -> None:
    state, _, recorder, _ = session
    search = begin_periodic_search(session)
    state.energy = 0.15
    state.add_start((0.26, 0.0))
    search.search()
    recorder.wait_for(lambda: recorder.all_computed(2) and recorder.orbits[1].periodic is not None)
    assert recorder.orbits[1].summarize() == "periodic, unstable"
    assert recorder.messages[-1].startswith("Rounding errors grow on this unstable orbit")
    # The verdict on the path stays with its values.
    assert recorder.orbits[1].describe() == recorder.orbits[1].verdict.describe()  # type: ignore[union-attr]
