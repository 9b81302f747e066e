"""The objects that the presenters of one session share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.latest_request import Locked
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.notice import Notice
from engine import System
from engine.jobs.client import JobSubmitter


@dataclass(frozen=True)
class SessionContext:
    """The state of a session, and the actions of its page.

    Attributes
    ----------
    state
        The view state.
    results
        The results for the state.
    jobs
        Computes results.
    notice
        Shows messages.
    locked, latest
        Wrap functions that change the document. `latest` runs only the latest of several waiting calls.
    copy
        Called with a text that is copied to the clipboard.
    open_view
        Called with a system, which is reviewed first, and with values of the view state that are shown with it.
    """

    state: ViewState
    results: ShownResults
    jobs: JobSubmitter
    notice: Notice
    locked: Locked
    latest: Locked
    copy: Callable[[str], None]
    open_view: Callable[[System, dict[str, Any]], None]
