"""Previews at the energies that the slider passes: one at a time, the latest energy next.

Under overload previews wait; the latest energy is requested when the overload ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.locking import Locked
from app.state.view_state import ViewState
from engine import EscapeMap
from engine.service import JobSubmitter, PreviewRequest, Subscription
from plots.image_columns import map_columns


@dataclass(frozen=True)
class LoadPolicy:
    """How a session behaves under overload.

    Attributes
    ----------
    is_overloaded
        Whether the server is overloaded.
    call_later
        Calls a function after a delay, under the session's lock.
    """

    is_overloaded: Callable[[], bool] = lambda: False
    call_later: Callable[[Callable[[], None]], Any] = lambda call: None


NO_OVERLOAD = LoadPolicy()
"""For a server that is never overloaded."""


class PreviewRequests:
    """Previews of one session; `show(frame, columns)` receives them, under the session's lock."""

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        show: Callable[[EscapeMap, dict[str, list[Any]]], None],
        locked: Locked,
        load_policy: LoadPolicy,
    ) -> None:
        self._state, self._jobs, self._show, self._load_policy = state, jobs, show, load_policy
        self._waiting = False
        self._wanted: float | None = None
        self._current: float | None = None
        self._subscription: Subscription | None = None
        self._deliver = locked(self._on_frame)

    @property
    def under_way(self) -> bool:
        """Whether a preview is being computed or shown."""
        return self._current is not None

    def request(self, energy: float) -> None:
        """Request a preview, at once or after the current one."""
        self._wanted = energy
        if not (self.under_way or self._waiting):
            self._begin()

    def cancel(self) -> None:
        """Cancel the current preview and the next one."""
        self._wanted = self._current = None
        if self._subscription is not None:
            self._subscription.cancel()
            self._subscription = None

    def _wait(self) -> None:
        self._waiting = True
        self._load_policy.call_later(self._retry)

    def _retry(self) -> None:
        self._waiting = False
        self._begin()

    def _begin(self) -> None:
        if self._wanted is not None and self._load_policy.is_overloaded():
            self._wait()
            return
        energy, self._wanted = self._wanted, None
        if energy is None:
            return
        self._current = energy
        self._subscription = self._jobs.request(
            PreviewRequest(self._state.unresolved_map_spec_at(energy)),
            lambda preview: self._pass_on(energy, preview.value, map_columns(preview.value, characters=False)),
            lambda error: self._pass_on(energy, None, {}),
        )

    def _pass_on(self, energy: float, frame: EscapeMap | None, columns: dict[str, list[Any]]) -> None:
        # The session keeps the latest call only: a late preview would replace the current one.
        if energy == self._current:
            self._deliver(energy, frame, columns)

    def _on_frame(self, energy: float, frame: EscapeMap | None, columns: dict[str, list[Any]]) -> None:
        if energy != self._current:
            return
        self._current = None
        # The next one is computed while this one is shown.
        self._begin()
        if frame is not None:
            self._show(frame, columns)
