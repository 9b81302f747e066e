"""Animation of the energy: previews at rising energies through the range of the slider."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

SWEEP_SECONDS = 20.0
"""Duration of an animation over the whole range, longer if previews are slow."""

TICK_MS = 80


class Timer(Protocol):
    """Calls back periodically: a Bokeh document."""

    def add_periodic_callback(self, callback: Callable[[], None], period_milliseconds: int) -> Any:
        """Start periodic calls."""

    def remove_periodic_callback(self, callback_obj: Any) -> None:
        """Stop periodic calls."""


class EnergyAnimation:
    """Raises the energy to the end of the range; from the start of the range if it is at the end.

    Parameters
    ----------
    timer
        The session's document.
    is_busy
        Whether the preview of the last energy is not finished; the tick is then skipped.
    on_energy
        Called with each energy.
    on_stop
        Called with the last energy.
    """

    def __init__(
        self, timer: Timer, is_busy: Callable[[], bool], on_energy: Callable[[float], None], on_stop: Callable[[float], None]
    ) -> None:
        self._timer, self._is_busy, self._on_energy, self._on_stop = timer, is_busy, on_energy, on_stop
        self._callback: Any = None
        self._energy = self._end = self._step = 0.0

    @property
    def playing(self) -> bool:
        """Whether the animation runs."""
        return self._callback is not None

    def start(self, energy: float, low: float, high: float) -> None:
        """Start at an energy; no effect while it runs."""
        if self.playing:
            return
        self._energy = energy if low <= energy < high else low
        self._end, self._step = high, (high - low) * TICK_MS / (1000.0 * SWEEP_SECONDS)
        self._callback = self._timer.add_periodic_callback(self._tick, TICK_MS)

    def stop(self) -> None:
        """Stop at the current energy."""
        if self.playing:
            self._timer.remove_periodic_callback(self._callback)
            self._callback = None
            self._on_stop(self._energy)

    def _tick(self) -> None:
        if not self.playing or self._is_busy():
            return
        self._energy = min(self._energy + self._step, self._end)
        self._on_energy(self._energy)
        if self._energy >= self._end:
            self.stop()
