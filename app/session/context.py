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


class History:
    """Counts the entries that the page has made, so that "Back" undoes one action of the user."""

    def __init__(self) -> None:
        self.entry = 0
        self._last = 0
        self._in_gesture = False
        self._gesture_recorded = False

    def record(self) -> int:
        """Return the number of the entry of a new state; all states of one gesture share an entry."""
        if not (self._in_gesture and self._gesture_recorded):
            self.entry += 1
            self._last = self.entry
            self._gesture_recorded = self._in_gesture
        return self.entry

    def begin_gesture(self) -> None:
        """Begin or continue a drag or a rotation of the wheel, which may change the state several times."""
        if not self._in_gesture:
            self._in_gesture, self._gesture_recorded = True, False

    def end_gesture(self) -> None:
        """End the gesture: the next change of the state gets a new entry."""
        self._in_gesture = False

    def move_to(self, entry: int) -> None:
        """Follow the browser to another entry; entries of an earlier page count as the first one."""
        self.end_gesture()
        self.entry = entry if 0 <= entry <= self._last else 0
