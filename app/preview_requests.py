"""Quick looks at energies that a visitor passes by: always one on its way, always the latest wanted next."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from app.locking import Locked
from app.map_columns import map_columns
from app.view_state import ViewState
from engine import EscapeMap, PreviewSpec, Requests, Ticket, preview_spec


class PreviewRequests:
    """One session's previews; `show(frame, columns)` paints one, under the session's lock."""

    def __init__(
        self, state: ViewState, jobs: Requests, show: Callable[[EscapeMap, dict[str, list[Any]]], None], locked: Locked
    ) -> None:
        self._state, self._jobs, self._show = state, jobs, show
        self._wanted: float | None = None
        self._under_way: float | None = None
        self._ticket: Ticket | None = None
        self._arrive = locked(self._arrived)

    @property
    def under_way(self) -> bool:
        """Whether one is being computed or painted."""
        return self._under_way is not None

    def request(self, energy: float) -> None:
        """Look at an energy: at once, or as soon as the last look is over."""
        self._wanted = energy
        if not self.under_way:
            self._begin()

    def cancel(self) -> None:
        """Look no more."""
        self._wanted = self._under_way = None
        if self._ticket is not None:
            self._ticket.cancel()
            self._ticket = None

    def _begin(self) -> None:
        energy, self._wanted = self._wanted, None
        if energy is None:
            return
        try:
            spec = self._state.map_spec_at(energy)
        except ValueError:
            return
        self._under_way = energy
        self._ticket = self._jobs.request(
            PreviewSpec(preview_spec(spec)),
            lambda preview: self._arrive(energy, preview.frame, map_columns(preview.frame, characters=False)),
            lambda error: self._arrive(energy, None, {}),
        )

    def _arrived(self, energy: float, frame: EscapeMap | None, columns: dict[str, list[Any]]) -> None:
        if energy != self._under_way:
            return
        self._under_way = None
        if frame is not None:
            self._show(frame, columns)
        self._begin()
