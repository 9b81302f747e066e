"""The chaos indicators of the orbit that is looked at; those that need more than its own history are asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from engine import BirkhoffDigits, BirkhoffDigitsRequest, Fate, IndicatorVerdict, Orbit, Requests, evaluate_indicators


class IndicatorsRequests:
    """One session's verdicts; `show(verdicts)` is told what each indicator says, empty for no orbit."""

    def __init__(
        self,
        state: ViewState,
        jobs: Requests,
        show: Callable[[Sequence[IndicatorVerdict]], None],
        say: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._show = state, show
        self._orbit: Orbit | None = None
        self._request = LatestRequest(jobs, self._answered, say, locked)

    def follow(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Judge what is looked at now."""
        chosen = self._state.chosen
        orbit = orbits[chosen].orbit if chosen < len(orbits) else None
        if orbit is not None and orbit is self._orbit:
            return
        self._orbit = orbit
        self._request.cancel()
        self._show(evaluate_indicators(orbit) if orbit is not None else ())
        if orbit is not None and orbit.fate == Fate.BOUNDED:
            spec = self._state.orbit_spec(orbits[chosen].start)
            assert spec is not None
            self._request.ask(BirkhoffDigitsRequest(spec.potential, spec.state, spec.t_max))

    def close(self) -> None:
        """Nobody waits for them any more."""
        self._request.cancel()

    def _answered(self, digits: BirkhoffDigits) -> None:
        if self._orbit is not None:
            self._show(evaluate_indicators(self._orbit, digits))
