"""The search for the twin of an orbit: the nearest start that leaves elsewhere."""

from __future__ import annotations

from collections.abc import Callable

from app.locking import Locked
from app.sentences import sentence
from app.view_state import ViewState
from engine import Jobs, Ticket, Twin, TwinSpec, describe_fate


class TwinRequest:
    """One session's search; the twin becomes one of the starts, and `say(sentence)` hears how it goes."""

    def __init__(self, state: ViewState, jobs: Jobs, say: Callable[[str], None], locked: Locked) -> None:
        self._state, self._jobs, self._say = state, jobs, say
        self._wanted: TwinSpec | None = None
        self._ticket: Ticket | None = None
        self._answer = locked(self._answered)

    def search(self) -> None:
        """Look around the orbit that is looked at."""
        self.close()
        state, start = self._state, self._state.chosen_start
        if start is None:
            self._say("Click a start first: its twin is the nearest start that leaves elsewhere.")
            return
        self._say("Searching for the nearest start that leaves elsewhere …")
        spec = self._wanted = TwinSpec(state.potential, state.plane, state.energy, *start, state.t_max)
        self._ticket = self._jobs.request_twin(
            spec, lambda twin: self._answer(spec, twin), lambda error: self._answer(spec, sentence(error))
        )

    def close(self) -> None:
        """Search no more."""
        self._wanted = None
        if self._ticket is not None:
            self._ticket.cancel()
            self._ticket = None

    def _answered(self, spec: TwinSpec, answer: Twin | str | None) -> None:
        if spec != self._wanted or self._state.chosen_start != (spec.x, spec.ordinate):
            return
        self._wanted = None
        if isinstance(answer, str):
            self._say(answer)
        elif answer is None:
            self._say("No start near this one leaves elsewhere.")
        else:
            self._state.add_start((answer.x, answer.ordinate))
            self._say(f"The twin starts {answer.distance:.2g} away. {describe_fate(answer.fate)}")
