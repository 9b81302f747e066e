"""History of windows: back, forward and home."""

from __future__ import annotations

from engine import Window


class ZoomHistory:
    """Windows in the order of visits; None, the whole interior, is the first."""

    def __init__(self) -> None:
        self._windows: list[Window | None] = [None]
        self._at = 0

    @property
    def window(self) -> Window | None:
        """The current window."""
        return self._windows[self._at]

    @property
    def can_go_back(self) -> bool:
        """Whether there is an earlier window."""
        return self._at > 0

    @property
    def can_go_forward(self) -> bool:
        """Whether there is a later window."""
        return self._at < len(self._windows) - 1

    def visit(self, window: Window | None) -> None:
        """Append a window and drop all later ones; no effect if it is the current one."""
        if window != self._windows[self._at]:
            self._windows[self._at + 1 :] = [window]
            self._at += 1

    def back(self) -> Window | None:
        """Go to the previous window, or stay at the first."""
        self._at = max(self._at - 1, 0)
        return self._windows[self._at]

    def forward(self) -> Window | None:
        """Go to the next window, or stay at the last."""
        self._at = min(self._at + 1, len(self._windows) - 1)
        return self._windows[self._at]

    def clear(self) -> None:
        """Reset the history, for another plane."""
        self._windows, self._at = [None], 0
