"""How the orbit that is looked at and the one before it part: asked for whenever both are there."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.locking import Locked
from app.orbit_requests import ChosenOrbit
from app.sentences import sentence
from app.view_state import ViewState
from engine import Jobs, Orbit, Separation, SeparationSpec, Ticket

Pair = tuple[int, int]


class SeparationRequest:
    """One session's comparison; `show(pair, separation)` is told of it, with None for none."""

    def __init__(
        self,
        state: ViewState,
        jobs: Jobs,
        show: Callable[[Pair | None, Separation | None], None],
        say: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._jobs, self._show, self._say = state, jobs, show, say
        self._wanted: SeparationSpec | None = None
        self._ticket: Ticket | None = None
        self._answer = locked(self._answered)

    def follow(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Compare what is there now."""
        pair = self._pair(orbits)
        spec = self._spec(*(orbits[place].orbit for place in pair)) if pair is not None else None
        if spec is not None and spec == self._wanted:
            return
        self.close()
        self._wanted = spec
        if spec is None:
            self._show(None, None)
            return
        self._ticket = self._jobs.request_separation(
            spec, lambda separation: self._answer(spec, pair, separation), lambda error: self._say(sentence(error))
        )

    def close(self) -> None:
        """Nobody waits for it any more."""
        self._wanted = None
        if self._ticket is not None:
            self._ticket.cancel()
            self._ticket = None

    def _answered(self, spec: SeparationSpec, pair: Pair, separation: Separation) -> None:
        if spec == self._wanted:
            self._show(pair, separation)

    def _pair(self, orbits: Sequence[ChosenOrbit]) -> Pair | None:
        """The places of the chosen orbit and of the one before it, the earlier first."""
        chosen = self._state.chosen
        pair = (chosen - 1, chosen) if chosen > 0 else (0, 1)
        there = pair[1] < len(orbits) and all(orbits[place].orbit is not None for place in pair)
        return pair if there else None

    def _spec(self, first: Orbit | None, second: Orbit | None) -> SeparationSpec | None:
        assert first is not None
        assert second is not None
        t_end = float(min(first.t[-1], second.t[-1]))
        return SeparationSpec(self._state.potential, _start(first), _start(second), t_end) if t_end > 0.0 else None


def _start(orbit: Orbit) -> tuple[float, float, float, float]:
    return float(orbit.x[0]), float(orbit.y[0]), float(orbit.px[0]), float(orbit.py[0])
