"""Follow-up analyses of complete maps are requested while they are wanted."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from app.job_clients.follow_up_requests import FollowUp, FollowUpRequests
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, Fate, MapSpec, Plane, Regularity, compute_map
from engine.jobs.manager import Jobs
from engine.results import RegularityMap
from plots.layers.regularity import REGULARITY
from tests.waiting import SECONDS

ON = frozenset({REGULARITY.name})


class Session:
    """A session with one follow-up analysis, regularity."""

    def __init__(self) -> None:
        self.state, self.jobs = ViewState(layers=ON), Jobs()
        self.results: list[tuple[EscapeMap, RegularityMap]] = []
        self.problems: list[str] = []
        self.changed = threading.Condition()
        self.request: Callable[[EscapeMap], Any] = lambda frame: REGULARITY.job(frame.spec, {})
        follow_up = FollowUp(lambda frame: self.request(frame) if self.state.layers else None, self.show, ("layers",))
        self.requests = FollowUpRequests(self.state, self.jobs, [follow_up], self.fail, lambda function: function)

    def fail(self, sentence: str) -> None:
        with self.changed:
            self.problems.append(sentence)
            self.changed.notify_all()

    def show(self, frame: EscapeMap, answer: RegularityMap) -> None:
        with self.changed:
            self.results.append((frame, answer))
            self.changed.notify_all()

    def wait_for_result(self, frame: EscapeMap) -> RegularityMap:
        with self.changed:
            assert self.changed.wait_for(
                lambda: bool(self.results) and self.results[-1][0] is frame and self.results[-1][1].complete, 60
            )
        return self.results[-1][1]


@pytest.fixture
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.requests.follow(None)


def bounded_map(energy: float, t_max: float = 100.0) -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, energy, (64, 64), t_max=t_max))


def test_maps_are_analysed_while_the_analysis_is_wanted(session: Session) -> None:
    session.state.layers = frozenset()
    frame = bounded_map(0.2)
    session.requests.follow(frame)
    assert session.jobs.in_flight == 0
    session.state.layers = ON
    regularity = session.wait_for_result(frame)
    assert np.any(frame.fate == Fate.BOUNDED)
    assert np.all(regularity.character[frame.fate == Fate.BOUNDED] != Regularity.NOT_JUDGED)
    other = bounded_map(0.21)
    session.requests.follow(other)
    session.wait_for_result(other)


def test_an_analysis_is_cancelled_when_it_is_no_longer_wanted(session: Session) -> None:
    session.requests.follow(bounded_map(0.12, t_max=1e5))
    session.state.layers = frozenset()
    assert session.jobs.in_flight == 0


def test_a_late_result_is_not_shown(session: Session) -> None:
    held: list[Callable[[], None]] = []
    follow_up = FollowUp(lambda frame: REGULARITY.job(frame.spec, {}), session.show)
    arrived = threading.Event()

    def lock(function: Callable[..., None]) -> Callable[..., None]:
        def hold(*arguments: Any) -> None:
            held.append(lambda: function(*arguments))
            arrived.set()

        return hold

    requests = FollowUpRequests(session.state, session.jobs, [follow_up], session.problems.append, lock)
    requests.follow(bounded_map(0.2))
    assert arrived.wait(SECONDS)
    requests.follow(None)
    for call in held:
        call()
    assert session.results == []


def test_an_error_gives_a_message(session: Session) -> None:
    bad = MapSpec(CASES["I"], Plane.X_PX, 1000.0, (8, 8), (-0.1, 0.1, -0.1, 0.1))
    session.request = lambda frame: REGULARITY.job(bad, {})
    session.requests.follow(bounded_map(0.2))
    with session.changed:
        assert session.changed.wait_for(lambda: bool(session.problems), SECONDS)
    assert session.problems[0].startswith("h = 1000: ")
