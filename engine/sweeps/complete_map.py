"""Check that the computation of a map was not cancelled."""

from __future__ import annotations

from concurrent.futures import CancelledError

from engine.maps.result import EscapeMap


def require_complete(frame: EscapeMap) -> EscapeMap:
    """Return the map. Raises `concurrent.futures.CancelledError` if it is not complete."""
    if not frame.complete:
        raise CancelledError
    return frame
