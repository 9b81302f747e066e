"""The background work of this process, which all sessions share, and whether too many wait for it."""

from __future__ import annotations

from functools import cache

from app.runtime.load_monitor import process_load_monitor
from app.runtime.settings import current_settings
from engine import Jobs

# Parts of jobs for each thread that may wait while there are still quick looks: one visitor's map makes two.
_MOST_WAITING = 4


@cache
def shared_jobs() -> Jobs:
    """The background work of this process, as whoever runs it has set it."""
    settings = current_settings()
    return Jobs(
        cache_bytes=settings.cache_bytes,
        most_orbits=settings.most_orbits,
        threads=settings.threads,
        only_idle=settings.only_idle,
    )


def is_pressed() -> bool:
    """Whether many wait, for the server's words or for its threads."""
    now = shared_jobs().figures()
    return process_load_monitor().is_high() or now.calls_waiting > _MOST_WAITING * now.threads


def is_waited() -> bool:
    """Whether anybody waits for anything."""
    return process_load_monitor().is_high() or shared_jobs().in_flight > 0
