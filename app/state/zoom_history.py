"""Where a visitor has been in a plane: back, forward, and the whole of it again."""

from __future__ import annotations

from engine import Window


class ZoomHistory:
    """Windows in the order of their visits; None is the whole interior, where every history begins."""

    def __init__(self) -> None:
        self._windows: list[Window | None] = [None]
        self._at = 0

    @property
    def window(self) -> Window | None:
        """Where the visitor is."""
        return self._windows[self._at]

    @property
    def can_go_back(self) -> bool:
        """Whether there is an earlier window."""
        return self._at > 0

    @property
    def can_go_forward(self) -> bool:
        """Whether the visitor has come back from a later window."""
        return self._at < len(self._windows) - 1

    def visit(self, window: Window | None) -> None:
        """A new window; those that the visitor had come back from are forgotten."""
        if window != self._windows[self._at]:
            self._windows[self._at + 1 :] = [window]
            self._at += 1

    def back(self) -> Window | None:
        """The window before, or the first."""
        self._at = max(self._at - 1, 0)
        return self._windows[self._at]

    def forward(self) -> Window | None:
        """The window after, or the last."""
        self._at = min(self._at + 1, len(self._windows) - 1)
        return self._windows[self._at]

    def clear(self) -> None:
        """Another plane: nothing has been visited but its whole."""
        self._windows, self._at = [None], 0
