"""Orbits of the chosen starts: requested, received, or refused with a message."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.error_messages import sentence
from app.job_clients.latest_request import Locked
from app.state.view import Start
from app.state.view_state import ViewState
from engine import Fate, Orbit, judge_orbit
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription
from engine.propagation.fates import describe_fate
from engine.results import BirkhoffDigits, OrbitVerdict
from plots.pictures.orbit_curves import OrbitCurves, compute_orbit_curves


@dataclass(frozen=True)
class ChosenOrbit:
    """A start with its orbit, or with the reason why it has none; both are missing while the orbit is computed.

    The Birkhoff digits follow later, for bounded orbits.
    """

    start: Start
    drawing: OrbitCurves | None = None
    problem: str = ""
    digits: BirkhoffDigits | None = None

    @property
    def orbit(self) -> Orbit | None:
        """The orbit, once it is computed."""
        return self.drawing.orbit if self.drawing is not None else None

    @property
    def verdict(self) -> OrbitVerdict | None:
        """The verdict on the orbit, as far as known."""
        return judge_orbit(self.orbit, self.digits) if self.orbit is not None else None

    def headline(self) -> str:
        """The verdict without its reasons, or why there is none."""
        return self.verdict.headline() if self.verdict is not None else self.problem or "Integrating …"

    def describe(self) -> str:
        """The verdict, or why there is none, in one sentence."""
        return self.verdict.describe() if self.verdict is not None else self.problem or "Integrating …"


class OrbitRequests:
    """Orbits of one session; `show(orbits)` is called after changes, under the session's lock.

    `latest` wraps a function so that of the calls that wait only the latest runs: results that arrive together are shown once.
    """

    def __init__(
        self, state: ViewState, jobs: JobSubmitter, show: Callable[[tuple[ChosenOrbit, ...]], None], latest: Locked
    ) -> None:
        self._state, self._jobs, self._show = state, jobs, show
        self._subscriptions: dict[Job[Orbit], Subscription | None] = {}
        self._results: dict[Job[Orbit], OrbitCurves | str] = {}
        self._shown: tuple[ChosenOrbit, ...] = ()
        # Results that are not shown yet; threads append to it.
        self._arrived: deque[tuple[Job[Orbit], OrbitCurves | str]] = deque()
        self._show_arrived = latest(self._take_arrived)
        state.param.watch(lambda *events: self.follow(), ["starts", "system", "plane", "energy", "t_max"])

    def follow(self) -> None:
        """Request the orbits of new starts and cancel those of removed ones."""
        wanted = [job for job in map(self._state.orbit_job, self._state.starts) if job is not None]
        for job in [job for job in self._subscriptions if job not in wanted]:
            _cancel(self._subscriptions.pop(job))
        self._results = {job: result for job, result in self._results.items() if job in wanted}
        for job in wanted:
            if job not in self._results and job not in self._subscriptions:
                self._request(job)
        self._notify()

    def close(self) -> None:
        """Cancel all requests."""
        for subscription in self._subscriptions.values():
            _cancel(subscription)
        self._subscriptions.clear()
        self._results.clear()

    def _request(self, job: Job[Orbit]) -> None:
        # A cached orbit is delivered before `request` returns.
        self._subscriptions[job] = None
        subscription = self._jobs.request(
            job,
            lambda orbit: self._deliver(job, compute_orbit_curves(job.arguments[0], orbit)),
            lambda error: self._deliver(job, sentence(error)),
        )
        if job in self._subscriptions:
            self._subscriptions[job] = subscription

    def _deliver(self, job: Job[Orbit], result: OrbitCurves | str) -> None:
        self._arrived.append((job, result))
        self._show_arrived()

    def _take_arrived(self) -> None:
        while self._arrived:
            job, result = self._arrived.popleft()
            if job in self._subscriptions:
                del self._subscriptions[job]
                self._results[job] = result
        self._notify()

    def _notify(self) -> None:
        orbits = tuple(self._orbit_of(start) for start in self._state.starts)
        # Drawing unchanged orbits again would delay a map that is requested at the same time.
        if orbits != self._shown:
            self._shown = orbits
            self._show(orbits)

    def _orbit_of(self, start: Start) -> ChosenOrbit:
        job = self._state.orbit_job(start)
        result: Any = describe_fate(Fate.FORBIDDEN) if job is None else self._results.get(job)
        return ChosenOrbit(start, problem=result) if isinstance(result, str) else ChosenOrbit(start, result)


def _cancel(subscription: Subscription | None) -> None:
    if subscription is not None:
        subscription.cancel()
