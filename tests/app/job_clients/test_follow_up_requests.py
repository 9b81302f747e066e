"""Second looks follow whole maps, while they are wanted."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from app.job_clients.follow_up_requests import FollowUp, FollowUpRequests
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, Fate, Jobs, MapSpec, Plane, Regularity, RegularityMap, RegularityRequest, compute_map


class Desk:
    """A session with one second look: the judging of bounded orbits."""

    def __init__(self) -> None:
        self.state, self.jobs = ViewState(judge=True), Jobs()
        self.seen: list[tuple[EscapeMap, RegularityMap]] = []
        self.problems: list[str] = []
        self.changed = threading.Condition()
        self.ask: Callable[[EscapeMap], Any] = lambda frame: RegularityRequest(frame.spec)
        look = FollowUp(lambda frame: self.ask(frame) if self.state.judge else None, self.show, ("judge",))
        self.looks = FollowUpRequests(self.state, self.jobs, [look], self.problems.append, lambda function: function)

    def show(self, frame: EscapeMap, answer: RegularityMap) -> None:
        with self.changed:
            self.seen.append((frame, answer))
            self.changed.notify_all()

    def wait_for_the_judgement_of(self, frame: EscapeMap) -> RegularityMap:
        with self.changed:
            assert self.changed.wait_for(lambda: bool(self.seen) and self.seen[-1][0] is frame and self.seen[-1][1].complete, 60)
        return self.seen[-1][1]


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.looks.follow(None)


def bounded_map(energy: float, t_max: float = 100.0) -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, energy, (64, 64), t_max=t_max))


def test_a_whole_map_is_looked_at(desk: Desk) -> None:
    frame = bounded_map(0.2)
    desk.looks.follow(frame)
    regularity = desk.wait_for_the_judgement_of(frame)
    assert np.any(frame.fate == Fate.BOUNDED)
    assert np.all(regularity.character[frame.fate == Fate.BOUNDED] != Regularity.NOT_JUDGED)


def test_each_new_map_is_looked_at(desk: Desk) -> None:
    for frame in (bounded_map(0.22), bounded_map(0.21)):
        desk.looks.follow(frame)
        desk.wait_for_the_judgement_of(frame)


def test_nothing_is_asked_while_it_is_not_wanted(desk: Desk) -> None:
    desk.state.judge = False
    desk.looks.follow(bounded_map(0.2))
    assert desk.jobs.in_flight == 0


def test_a_look_begins_when_it_becomes_wanted(desk: Desk) -> None:
    desk.state.judge = False
    frame = bounded_map(0.2)
    desk.looks.follow(frame)
    desk.state.judge = True
    desk.wait_for_the_judgement_of(frame)


def test_work_stops_once_it_is_not_wanted(desk: Desk) -> None:
    desk.looks.follow(bounded_map(0.12, t_max=1e5))
    desk.state.judge = False
    assert desk.jobs.in_flight == 0


def test_an_answer_that_comes_after_the_map_has_gone_is_not_shown(desk: Desk) -> None:
    held: list[Callable[[], None]] = []
    look = FollowUp(lambda frame: RegularityRequest(frame.spec), desk.show)
    arrived = threading.Event()

    def lock(function: Callable[..., None]) -> Callable[..., None]:
        def hold(*arguments: Any) -> None:
            held.append(lambda: function(*arguments))
            arrived.set()

        return hold

    looks = FollowUpRequests(desk.state, desk.jobs, [look], desk.problems.append, lock)
    looks.follow(bounded_map(0.2))
    assert arrived.wait(60)
    looks.follow(None)
    for call in held:
        call()
    assert desk.seen == []


def test_a_problem_is_told_in_words(desk: Desk) -> None:
    frame = bounded_map(0.2)
    bad = MapSpec(CASES["I"], Plane.X_PX, 50.0, (8, 8), (-0.1, 0.1, -0.1, 0.1))  # type: ignore[arg-type]
    desk.ask = lambda frame: RegularityRequest(bad)
    desk.looks.follow(frame)
    for _ in range(200):
        if desk.problems:
            break
        threading.Event().wait(0.1)
    assert "energy=50.0" in desk.problems[0]
