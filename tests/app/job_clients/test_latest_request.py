"""One request at a time: only the answer to the last one is heard."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from app.job_clients.latest_request import LatestRequest
from engine import CASES, Jobs, Orbit, OrbitRequest

SPEC = OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, 0.5), 50.0)


class Desk:
    def __init__(self) -> None:
        self.jobs = Jobs()
        self.answers: list[Any] = []
        self.problems: list[str] = []
        self.heard = threading.Event()
        self.request = LatestRequest(self.jobs, self.hear, self.fail, lambda function: function)

    def hear(self, answer: Any) -> None:
        self.answers.append(answer)
        self.heard.set()

    def fail(self, sentence: str) -> None:
        self.problems.append(sentence)
        self.heard.set()

    def wait(self) -> None:
        assert self.heard.wait(30)
        self.heard.clear()


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.request.cancel()


def test_the_answer_is_heard(desk: Desk) -> None:
    desk.request.ask(SPEC)
    desk.wait()
    assert isinstance(desk.answers[0], Orbit)


def test_the_same_question_is_not_asked_twice(desk: Desk) -> None:
    desk.request.ask(SPEC)
    desk.wait()
    desk.request.ask(SPEC)
    assert len(desk.answers) == 1


def test_a_new_question_stops_the_last(desk: Desk) -> None:
    desk.request.ask(replace(SPEC, potential=CASES["III"], state=(0.0, 0.0, 0.1, 0.5), t_max=1e7))
    desk.request.ask(SPEC)
    assert desk.jobs.in_flight == 1
    desk.wait()
    assert desk.answers[0].t[-1] <= 50.0


def test_nothing_is_heard_once_it_is_cancelled(desk: Desk) -> None:
    desk.request.ask(replace(SPEC, potential=CASES["III"], state=(0.0, 0.0, 0.1, 0.5), t_max=1e7))
    desk.request.cancel()
    assert desk.jobs.in_flight == 0
    assert not desk.heard.wait(0.5)


def test_a_problem_is_told_in_words_and_may_be_asked_again(desk: Desk) -> None:
    bad = replace(SPEC, t_max=-1.0)
    for _ in range(2):
        desk.request.ask(bad)
        desk.wait()
    assert len(desk.problems) == 2
    assert "t_max=-1.0" in desk.problems[0]
