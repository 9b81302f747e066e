"""What the presenters of one session share: state, results, services, and the entries of the browser's history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.job_clients.latest_request import Locked
from app.job_clients.shown_results import ShownResults
from app.state.view_state import STARTS_FULL, ViewState
from app.views.components.notice import Notice
from engine import System
from engine.jobs.client import JobSubmitter
from plots.studies.study import Changes


@dataclass(frozen=True)
class SessionContext:
    """The state of a session, and the actions of its page.

    Attributes
    ----------
    state
        The view state.
    results
        The results for the view state.
    jobs
        Computes results.
    notice
        Shows messages.
    locked, latest
        Wrap a function to run under the session's lock. Of several waiting calls, `latest` runs only the latest.
    copy
        Copies a text to the clipboard.
    open_view
        Reviews a system, then shows it with the given values of the view state.
    """

    state: ViewState
    results: ShownResults
    jobs: JobSubmitter
    notice: Notice
    locked: Locked
    latest: Locked
    copy: Callable[[str], None]
    open_view: Callable[[System, dict[str, Any]], None]

    def change(self, changes: Changes) -> None:
        """Change the view as a study says."""
        changes = dict(changes)
        system, start = changes.pop("system", None), changes.pop("start", None)
        if changes.get("plane", self.state.plane) != self.state.plane:
            # Window and starts belong to the other slice.
            changes = {"window": None, "starts": (), "chosen": 0, **changes}
        if system is not None:
            self.open_view(system, changes)
            return
        self.state.param.update(**changes)
        if start is not None and not self.state.add_start(start):
            self.notice.show(STARTS_FULL)


class History:
    """Numbers the entries of the browser's history. Each action of the user has one entry, so "Back" undoes one action."""

    def __init__(self) -> None:
        self.entry = 0
        """The present entry."""
        # The last entry. After "Back", it follows the present entry.
        self._last_entry = 0
        self._in_gesture = False
        self._gesture_recorded = False

    def record(self) -> int:
        """Return the entry of a new state. All states of one gesture share an entry."""
        if not (self._in_gesture and self._gesture_recorded):
            self.entry += 1
            self._last_entry = self.entry
            self._gesture_recorded = self._in_gesture
        return self.entry

    def begin_gesture(self) -> None:
        """Begin or continue a gesture: a drag or a turn of the wheel, which may change the state several times."""
        if not self._in_gesture:
            self._in_gesture, self._gesture_recorded = True, False

    def end_gesture(self) -> None:
        """End the gesture: the next change of the state gets a new entry."""
        self._in_gesture = False

    def move_to(self, entry: int) -> None:
        """Follow the browser to another entry; an entry of an earlier page counts as the first entry."""
        self.end_gesture()
        self.entry = entry if 0 <= entry <= self._last_entry else 0
