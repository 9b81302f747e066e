"""Only results of the latest request are delivered."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from app.job_clients.latest_request import LatestRequest
from engine import CASES, Orbit, integrate_orbit
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from tests.waiting import SECONDS

ORBIT = Job(integrate_orbit, (CASES["I"], (0.1, 0.0, 0.05, 0.5), 50.0), queue=Queue.LONG_CALL)
LONG_ORBIT = replace(ORBIT, arguments=(CASES["III"], (0.0, 0.0, 0.1, 0.5), 1e7))


class Client:
    def __init__(self) -> None:
        self.jobs = Jobs()
        self.results: list[Any] = []
        self.problems: list[str] = []
        self.called = threading.Event()
        self.request = LatestRequest(self.jobs, self.show, self.fail, lambda function: function)

    def show(self, result: Any) -> None:
        self.results.append(result)
        self.called.set()

    def fail(self, sentence: str) -> None:
        self.problems.append(sentence)
        self.called.set()

    def wait(self) -> None:
        assert self.called.wait(SECONDS)
        self.called.clear()


@pytest.fixture
def client() -> Iterator[Client]:
    client = Client()
    yield client
    client.request.cancel()


def test_a_result_is_delivered_once(client: Client) -> None:
    for _ in range(2):
        client.request.submit(ORBIT)
        client.wait()
        client.called.set()
    assert [type(result) for result in client.results] == [Orbit]


def test_a_new_request_or_a_cancel_ends_the_last(client: Client) -> None:
    client.request.submit(LONG_ORBIT)
    client.request.cancel()
    assert client.jobs.in_flight == 0
    client.request.submit(LONG_ORBIT)
    client.request.submit(ORBIT)
    assert client.jobs.in_flight == 1
    client.wait()
    assert client.results[0].t[-1] <= 50.0


def test_an_error_gives_a_message_and_allows_the_same_request_again(client: Client) -> None:
    bad = replace(ORBIT, arguments=(*ORBIT.arguments[:2], -1.0))
    for _ in range(2):
        client.request.submit(bad)
        client.wait()
    assert len(client.problems) == 2
    assert "t_max=-1.0" in client.problems[0]


def test_of_several_jobs_only_the_last_is_shown_once_the_others_have_finished(client: Client) -> None:
    client.request.submit(replace(ORBIT, arguments=(*ORBIT.arguments[:2], 20.0)), ORBIT)
    client.wait()
    assert [result.t[-1] for result in client.results] == [50.0]


def test_a_job_after_one_that_fails_is_not_requested(client: Client) -> None:
    client.request.submit(replace(ORBIT, arguments=(*ORBIT.arguments[:2], -1.0)), LONG_ORBIT)
    client.wait()
    assert "t_max=-1.0" in client.problems[0]
    assert client.jobs.in_flight == 0
