"""Make a session without a page, whose lock notifies waiting tests when a callback has run."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from app.job_clients.latest_request import Locked
from app.job_clients.shown_results import ShownResults
from app.session.context import SessionContext
from app.state.view_state import ViewState
from app.views.components.notice import Notice
from engine import System
from engine.jobs.client import JobClient
from engine.jobs.manager import Jobs


def locked_by(changed: threading.Condition) -> Locked:
    """Return a decorator that runs calls under a condition, and then notifies the waiting threads."""

    def locked(function: Callable[..., None]) -> Callable[..., None]:
        def call(*arguments: Any, **named: Any) -> None:
            with changed:
                function(*arguments, **named)
                changed.notify_all()

        return call

    return locked


def context_of(
    state: ViewState,
    jobs: Jobs,
    changed: threading.Condition,
    open_view: Callable[[System, dict[str, Any]], None] = lambda system, values: None,
) -> SessionContext:
    """Return the context that presenters share in a session with this lock. It copies nothing to the clipboard."""
    locked = locked_by(changed)
    return SessionContext(state, ShownResults(), JobClient(jobs), Notice(), locked, locked, lambda text: None, open_view)
