"""Chaos indicators of the chosen orbit; Birkhoff digits, which need more than its history, are requested."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from engine import BirkhoffDigits, BirkhoffDigitsRequest, Fate, IndicatorVerdict, JobSubmitter, Orbit, evaluate_indicators


class IndicatorsRequests:
    """Indicators of one session; `show(verdicts)` receives one verdict per indicator, none if there is no orbit."""

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        show: Callable[[Sequence[IndicatorVerdict]], None],
        notify: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._show = state, show
        self._orbit: Orbit | None = None
        self._request = LatestRequest(jobs, self._on_digits, notify, locked)

    def follow(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Evaluate the indicators of the chosen orbit."""
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
            self._request.submit(BirkhoffDigitsRequest(spec.potential, spec.state, spec.t_max))

    def close(self) -> None:
        """Cancel the request."""
        self._request.cancel()

    def _on_digits(self, digits: BirkhoffDigits) -> None:
        if self._orbit is not None:
            self._show(evaluate_indicators(self._orbit, digits))
