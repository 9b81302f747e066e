"""The orbits that a visitor has chosen: asked for, on their way, here, or refused in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.error_messages import sentence
from app.job_clients.locking import Locked
from app.rendering.orbit_curves import OrbitCurves, compute_orbit_curves
from app.state.system import SYSTEM
from app.state.view_state import Start, ViewState
from engine import Fate, Orbit, OrbitRequest, Requests, Subscription, describe_fate


@dataclass(frozen=True)
class ChosenOrbit:
    """A start and what is known of its orbit: its drawing, or the reason why there is none; neither while it is on its way."""

    start: Start
    drawing: OrbitCurves | None = None
    problem: str = ""

    @property
    def orbit(self) -> Orbit | None:
        """The orbit, if it is here."""
        return self.drawing.orbit if self.drawing is not None else None


class OrbitRequests:
    """One session's orbits; `show(orbits)` is told of every change, under the session's lock."""

    def __init__(self, state: ViewState, jobs: Requests, show: Callable[[tuple[ChosenOrbit, ...]], None], locked: Locked) -> None:
        self._state, self._jobs, self._show = state, jobs, show
        self._tickets: dict[OrbitRequest, Subscription | None] = {}
        self._answers: dict[OrbitRequest, OrbitCurves | str] = {}
        self._told: tuple[ChosenOrbit, ...] = ()
        self._answer = locked(self._answered)
        state.param.watch(lambda *events: self.follow(), ["starts", *SYSTEM, "plane", "energy", "t_max"])

    def follow(self) -> None:
        """Ask for what is wanted and not known, and give up what is not wanted any more."""
        wanted = [spec for spec in map(self._state.orbit_spec, self._state.starts) if spec is not None]
        for spec in [spec for spec in self._tickets if spec not in wanted]:
            _cancel(self._tickets.pop(spec))
        self._answers = {spec: answer for spec, answer in self._answers.items() if spec in wanted}
        for spec in wanted:
            if spec not in self._answers and spec not in self._tickets:
                self._request(spec)
        self._tell()

    def close(self) -> None:
        """Nobody waits for them any more."""
        for ticket in self._tickets.values():
            _cancel(ticket)
        self._tickets.clear()
        self._answers.clear()

    def _request(self, spec: OrbitRequest) -> None:
        # An orbit that is kept may come before its ticket.
        self._tickets[spec] = None
        ticket = self._jobs.request(
            spec,
            lambda orbit: self._answer(spec, compute_orbit_curves(spec.potential, orbit)),
            lambda error: self._answer(spec, sentence(error)),
        )
        if spec in self._tickets:
            self._tickets[spec] = ticket

    def _answered(self, spec: OrbitRequest, answer: OrbitCurves | str) -> None:
        if spec in self._tickets:
            del self._tickets[spec]
            self._answers[spec] = answer
            self._tell()

    def _tell(self) -> None:
        known = tuple(self._known(start) for start in self._state.starts)
        # Drawing nothing anew would delay the map that is wanted at the same time.
        if known != self._told:
            self._told = known
            self._show(known)

    def _known(self, start: Start) -> ChosenOrbit:
        spec = self._state.orbit_spec(start)
        answer: Any = describe_fate(Fate.FORBIDDEN) if spec is None else self._answers.get(spec)
        return ChosenOrbit(start, problem=answer) if isinstance(answer, str) else ChosenOrbit(start, answer)


def _cancel(ticket: Subscription | None) -> None:
    if ticket is not None:
        ticket.cancel()
