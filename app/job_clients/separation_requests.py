"""How the orbit that is looked at and the one before it part: asked for whenever both are there."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from engine import Orbit, Requests, Separation, SeparationRequest

Pair = tuple[int, int]


class SeparationRequests:
    """One session's comparison; `show(pair, separation)` is told of it, with None for none."""

    def __init__(
        self,
        state: ViewState,
        jobs: Requests,
        show: Callable[[Pair | None, Separation | None], None],
        say: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._show = state, show
        self._compared: Pair | None = None
        self._request = LatestRequest(jobs, lambda separation: show(self._compared, separation), say, locked)

    def follow(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Compare what is there now."""
        self._compared = self._pair(orbits)
        spec = self._spec(*(orbits[place].orbit for place in self._compared)) if self._compared is not None else None
        if spec is not None:
            self._request.ask(spec)
        else:
            self._request.cancel()
            self._show(None, None)

    def close(self) -> None:
        """Nobody waits for it any more."""
        self._request.cancel()

    def _pair(self, orbits: Sequence[ChosenOrbit]) -> Pair | None:
        """The places of the chosen orbit and of the one before it, the earlier first."""
        chosen = self._state.chosen
        pair = (chosen - 1, chosen) if chosen > 0 else (0, 1)
        there = pair[1] < len(orbits) and all(orbits[place].orbit is not None for place in pair)
        return pair if there else None

    def _spec(self, first: Orbit | None, second: Orbit | None) -> SeparationRequest | None:
        assert first is not None
        assert second is not None
        t_end = float(min(first.t[-1], second.t[-1]))
        return SeparationRequest(self._state.potential, _start(first), _start(second), t_end) if t_end > 0.0 else None


def _start(orbit: Orbit) -> tuple[float, float, float, float]:
    return float(orbit.x[0]), float(orbit.y[0]), float(orbit.px[0]), float(orbit.py[0])
