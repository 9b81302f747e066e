"""Keys and addresses pass between the browser and the page."""

from __future__ import annotations

from typing import Any

from app.state.view_state import ViewState
from app.views.panels.browser_events import KEYS, BrowserEvents
from tests.app.browser_messages import send


def events_of(*keys: str) -> tuple[BrowserEvents, list[tuple[Any, ...]]]:
    """Return events, and the recorded arguments of their listeners."""
    calls: list[tuple[Any, ...]] = []
    return BrowserEvents(ViewState(), keys or KEYS, lambda call: call, *[lambda *values: calls.append(values)] * 3), calls


def test_keys_that_a_page_does_not_use_are_left_to_the_browser() -> None:
    events, calls = events_of("h")
    send(events, {"key": "h"}, {"key": "b"})
    assert calls == [("h",)]
    assert events.keys == ["h"]


def test_each_change_of_the_address_names_the_last_known_steps_through_the_history() -> None:
    events, _ = events_of()
    written: list[Any] = []
    events.param.watch(lambda event: written.append(event.new), "address")
    for steps in (0, 0, 3):
        events.follow_steps(steps)
        events.show_address("?case=II", 1)
    assert [(address["link"], address["entry"], address["steps"]) for address in written] == [
        ("?case=II", 1, steps) for steps in (0, 0, 3)
    ]
