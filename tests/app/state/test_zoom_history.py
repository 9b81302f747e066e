"""History of windows, as in a browser."""

from __future__ import annotations

from app.state.zoom_history import ZoomHistory
from engine import Window

A, B, C = (Window(0.0, side, 0.0, side) for side in (1.0, 0.5, 0.25))


def test_back_ends_at_the_whole_interior_and_forward_returns() -> None:
    history = ZoomHistory()
    history.visit(A)
    history.visit(B)
    assert (history.back(), history.back(), history.back()) == (A, None, None)
    assert (history.forward(), history.forward(), history.forward()) == (A, B, B)


def test_a_new_window_drops_later_ones() -> None:
    history = ZoomHistory()
    history.visit(A)
    history.visit(B)
    history.back()
    history.visit(C)
    assert not history.can_go_forward
    assert history.back() == A


def test_the_current_window_is_not_added_again() -> None:
    history = ZoomHistory()
    history.visit(None)
    assert not history.can_go_back


def test_a_cleared_history_is_empty() -> None:
    history = ZoomHistory()
    history.visit(A)
    history.clear()
    assert not history.can_go_back
    assert history.forward() is None
