"""Chaos indicators of the orbits; Birkhoff digits need more than the history of an orbit, and are requested as jobs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from app.job_clients.error_messages import sentence
from app.job_clients.latest_request import Locked
from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from engine import Fate, Orbit
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.jobs.subscription import Subscription
from engine.results import BirkhoffDigits
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import IndicatorVerdict, evaluate_indicators


class IndicatorsRequests:
    """Indicators of one session.

    `show(orbits, verdicts)` receives the orbits with their digits, as far as known, and one verdict per indicator on the chosen
    orbit, none if there is no orbit.
    """

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        show: Callable[[Sequence[ChosenOrbit], Sequence[IndicatorVerdict]], None],
        notify: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._jobs, self._show, self._notify = state, jobs, show, notify
        self._orbits: tuple[ChosenOrbit, ...] = ()
        self._digits: dict[Orbit, BirkhoffDigits] = {}
        self._subscriptions: dict[Orbit, Subscription | None] = {}
        self._deliver = locked(self._on_result)

    def follow(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Evaluate the indicators of the orbits."""
        self._orbits = tuple(orbits)
        bounded = {one.orbit: one for one in orbits if one.orbit is not None and one.orbit.fate == Fate.BOUNDED}
        for orbit in self._subscriptions.keys() - bounded.keys():
            self._cancel(orbit)
        self._digits = {orbit: digits for orbit, digits in self._digits.items() if orbit in bounded}
        for orbit, one in bounded.items():
            if orbit not in self._digits and orbit not in self._subscriptions:
                self._request(orbit, one)
        self._update()

    def close(self) -> None:
        """Cancel all requests."""
        for orbit in tuple(self._subscriptions):
            self._cancel(orbit)

    def _request(self, orbit: Orbit, one: ChosenOrbit) -> None:
        orbit_job = self._state.orbit_job(one.start)
        assert orbit_job is not None
        job = Job(compute_birkhoff_digits, orbit_job.arguments, queue=Queue.LONG_CALL)
        # Cached digits are delivered before `request` returns.
        self._subscriptions[orbit] = None
        deliver = partial(self._deliver, orbit)
        subscription = self._jobs.request(job, deliver, deliver)
        if orbit in self._subscriptions:
            self._subscriptions[orbit] = subscription

    def _on_result(self, orbit: Orbit, result: BirkhoffDigits | Exception) -> None:
        if orbit not in self._subscriptions:
            return
        del self._subscriptions[orbit]
        if isinstance(result, Exception):
            self._notify(sentence(result))
        else:
            self._digits[orbit] = result
            self._update()

    def _update(self) -> None:
        """Show the results so far."""
        orbits, chosen = [self._with_digits(one) for one in self._orbits], self._state.chosen
        one = orbits[chosen] if chosen < len(orbits) else None
        self._show(orbits, evaluate_indicators(one.orbit, one.digits) if one is not None and one.orbit is not None else ())

    def _with_digits(self, one: ChosenOrbit) -> ChosenOrbit:
        return replace(one, digits=self._digits.get(one.orbit)) if one.orbit is not None else one

    def _cancel(self, orbit: Orbit) -> None:
        subscription = self._subscriptions.pop(orbit)
        if subscription is not None:
            subscription.cancel()
