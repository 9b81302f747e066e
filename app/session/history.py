"""The position of a page in the history of its browser."""

from __future__ import annotations


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
