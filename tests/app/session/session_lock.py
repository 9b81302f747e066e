"""A lock in place of that of a session, which tells waiting tests when a callback has run."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from app.job_clients.latest_request import Locked


def locked_by(changed: threading.Condition) -> Locked:
    """Runs functions under a condition, and notifies those that wait for it."""

    def locked(function: Callable[..., None]) -> Callable[..., None]:
        def call(*arguments: Any, **named: Any) -> None:
            with changed:
                function(*arguments, **named)
                changed.notify_all()

        return call

    return locked
