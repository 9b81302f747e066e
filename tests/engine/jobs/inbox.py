"""Receive the results of jobs, and wait for jobs, in tests."""

from __future__ import annotations

import threading
from typing import Any

from engine.jobs.manager import Jobs
from tests.waiting import wait_until


class Inbox:
    """Collects what the callbacks of one request receive."""

    def __init__(self) -> None:
        self.results: list[Any] = []
        self.errors: list[Exception] = []
        self.first, self.done = threading.Event(), threading.Event()

    def result(self, result: Any) -> None:
        self.results.append(result)
        self.first.set()
        if getattr(result, "complete", True):
            self.done.set()

    def error(self, error: Exception) -> None:
        self.errors.append(error)
        self.done.set()


def wait_until_idle(jobs: Jobs) -> None:
    wait_until(lambda: jobs.in_flight == 0)
