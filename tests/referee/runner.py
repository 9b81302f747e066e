"""Run the checks of many formulas in child processes, each of which ends if a formula takes too long."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

import psutil

from tests.referee.formulas import EXAMPLES, Formula, random_formula
from tests.referee.report import TOO_LONG, Report

SECONDS = 120.0
"""Longest processor time for a formula, in seconds, on which other programs have no influence."""


@dataclass(frozen=True)
class Task:
    """A formula, named for the report, with its seed, the number of its energies and the checks."""

    name: str
    formula: Formula
    seed: int
    energies: int
    checks: tuple[str, ...]

    def run(self) -> Iterator[Report]:
        """Yield a report after each check."""
        # The parent process compiles nothing.
        from tests.referee.checks import check_in_parts

        for report in check_in_parts(self.formula, self.seed, self.energies, self.checks):
            for finding in report.wrong:
                finding |= {"task": self.name, "seed": self.seed}
            yield report


def example_tasks(checks: tuple[str, ...]) -> list[Task]:
    return [Task(name, formula, seed=0, energies=1, checks=checks) for name, formula in EXAMPLES.items()]


def random_tasks(seeds: Sequence[int], energies: int, checks: tuple[str, ...]) -> list[Task]:
    return [Task(f"random {seed}", random_formula(seed), seed, energies, checks) for seed in seeds]


def run_tasks(tasks: Sequence[Task], jobs: int, seconds: float = SECONDS) -> Iterator[tuple[Task, Report]]:
    """Yield the tasks with their reports as they end."""
    waiting, workers = list(reversed(tasks)), [_Worker() for _ in range(min(jobs, len(tasks)))]
    try:
        while waiting or any(worker.task for worker in workers):
            for worker in workers:
                if waiting and worker.task is None:
                    worker.begin(waiting.pop())
            busy = [worker for worker in workers if worker.task]
            wait([worker.connection for worker in busy], timeout=1.0)
            for worker in busy:
                task = worker.task
                if task and (report := worker.answer(seconds)) is not None:
                    yield task, report
    finally:
        for worker in workers:
            worker.stop()


class _Worker:
    """A child process that runs one task at a time."""

    def __init__(self) -> None:
        self.task: Task | None = None
        self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(other,), daemon=True)
        self.process.start()
        other.close()

    def begin(self, task: Task) -> None:
        self.task, self.since, self.report = task, self._processor_time(), Report()
        self.connection.send(task)

    def answer(self, seconds: float) -> Report | None:
        """Return the report of the task if it has ended or takes too long."""
        text = self.task.formula.text if self.task else ""
        if self.connection.poll():
            try:
                if (part := self.connection.recv()) is not None:
                    self.report.merge(part)
                    return None
            except EOFError:
                self.report.add_wrong("process", "the process ended", formula=text)
                self._restart()
        elif self._processor_time() - self.since > seconds:
            self.report.add("time", TOO_LONG, text)
            self._restart()
        else:
            return None
        self.task = None
        return self.report

    def _processor_time(self) -> float:
        times = psutil.Process(self.process.pid).cpu_times()
        return times.user + times.system

    def _restart(self) -> None:
        self.stop()
        self._start()

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.connection.close()


def _serve(connection: Connection) -> None:
    """Run the tasks that arrive, in a child process, and send None after each. An error of a check is kept as a wrong answer."""
    while True:
        task: Task = connection.recv()
        try:
            for report in task.run():
                connection.send(report)
        except Exception as error:
            report = Report()
            known: dict[str, Any] = {"task": task.name, "seed": task.seed, "formula": task.formula.text}
            report.add_wrong("process", f"{type(error).__name__} in a check", **known, error=str(error), trace=_trace(error))
            connection.send(report)
        connection.send(None)


def _trace(error: BaseException) -> list[str]:
    import traceback

    return [f"{frame.filename}:{frame.lineno} {frame.name}" for frame in traceback.extract_tb(error.__traceback__)][-6:]
