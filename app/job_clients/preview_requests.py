"""Quick looks at energies that a visitor passes by: always one on its way, always the latest wanted next.

While many wait for their first picture there are none; the latest wanted comes when that is over.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.locking import Locked
from app.rendering.image_columns import map_columns
from app.state.view_state import ViewState
from engine import EscapeMap, PreviewRequest, Requests, Subscription


@dataclass(frozen=True)
class LoadPolicy:
    """How to wait while others wait for more.

    Attributes
    ----------
    is_pressed
        Whether many wait.
    later
        Calls back in a while, under the session's lock.
    """

    is_pressed: Callable[[], bool] = lambda: False
    later: Callable[[Callable[[], None]], Any] = lambda call: None


UNHURRIED = LoadPolicy()
"""Nobody else is there."""


class PreviewRequests:
    """One session's previews; `show(frame, columns)` paints one, under the session's lock."""

    def __init__(
        self,
        state: ViewState,
        jobs: Requests,
        show: Callable[[EscapeMap, dict[str, list[Any]]], None],
        locked: Locked,
        patience: LoadPolicy,
    ) -> None:
        self._state, self._jobs, self._show, self._patience = state, jobs, show, patience
        self._waiting = False
        self._wanted: float | None = None
        self._under_way: float | None = None
        self._ticket: Subscription | None = None
        self._arrive = locked(self._arrived)

    @property
    def under_way(self) -> bool:
        """Whether one is being computed or painted."""
        return self._under_way is not None

    def request(self, energy: float) -> None:
        """Look at an energy: at once, or as soon as the last look is over."""
        self._wanted = energy
        if not (self.under_way or self._waiting):
            self._begin()

    def cancel(self) -> None:
        """Look no more."""
        self._wanted = self._under_way = None
        if self._ticket is not None:
            self._ticket.cancel()
            self._ticket = None

    def _wait(self) -> None:
        self._waiting = True
        self._patience.later(self._waited)

    def _waited(self) -> None:
        self._waiting = False
        self._begin()

    def _begin(self) -> None:
        if self._wanted is not None and self._patience.is_pressed():
            self._wait()
            return
        energy, self._wanted = self._wanted, None
        if energy is None:
            return
        self._under_way = energy
        self._ticket = self._jobs.request(
            PreviewRequest(self._state.unresolved_map_spec_at(energy)),
            lambda preview: self._answer(energy, preview.frame, map_columns(preview.frame, characters=False)),
            lambda error: self._answer(energy, None, {}),
        )

    def _answer(self, energy: float, frame: EscapeMap | None, columns: dict[str, list[Any]]) -> None:
        # The session keeps the latest only: what is late must not take the place of what is wanted now.
        if energy == self._under_way:
            self._arrive(energy, frame, columns)

    def _arrived(self, energy: float, frame: EscapeMap | None, columns: dict[str, list[Any]]) -> None:
        if energy != self._under_way:
            return
        self._under_way = None
        if frame is not None:
            self._show(frame, columns)
        self._begin()
