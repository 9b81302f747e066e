"""Messages of the browser become calls; what is not expected is ignored."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest

from app.views.panels.browser_events import KEYS, BrowserActions, BrowserEvents, key_legend


@pytest.fixture
def calls() -> list[tuple[Any, ...]]:
    return []


@pytest.fixture
def events(calls: list[tuple[Any, ...]]) -> BrowserEvents:
    def record(name: str) -> Any:
        return lambda *values: calls.append((name, *values))

    return BrowserEvents(BrowserActions(*[record(field.name) for field in fields(BrowserActions)]))


def test_each_message_calls_its_action(events: BrowserEvents, calls: list[tuple[Any, ...]]) -> None:
    messages = [
        {"key": "h"},
        {"link": "?case=II", "entry": 3, "steps": 1},
        {"dark": True},
        {"touch": True},
        {"narrow": True},
        {"copied": False},
    ]
    for message in messages:
        events._receive(message)
    assert calls == [
        ("key", "h"),
        ("navigate", "?case=II", 3, 1),
        ("dark", True),
        ("touch",),
        ("narrow",),
        ("copied", False),
    ]


@pytest.mark.parametrize(
    "message",
    [None, 7, "h", [], {}, {"key": "x"}, {"key": 7}, {"dark": "yes"}, {"touch": False}, {"link": 7, "entry": 1, "steps": 1}],
)
def test_other_messages_are_ignored(events: BrowserEvents, calls: list[tuple[Any, ...]], message: Any) -> None:
    events._receive(message)
    assert calls == []


def test_keys_that_a_page_does_not_use_are_left_to_the_browser(calls: list[tuple[Any, ...]]) -> None:
    some = BrowserEvents(BrowserActions(*[lambda *values: calls.append(values) for _ in fields(BrowserActions)]), ["h"])
    for key in ("h", "b"):
        some._receive({"key": key})
    assert calls == [("h",)]
    assert some.layout().keys == ["h"]


def test_every_key_is_in_the_list_of_keys() -> None:
    assert all(action in key_legend() for action in KEYS.values())


def test_the_same_link_twice_is_two_changes(events: BrowserEvents) -> None:
    written: list[Any] = []
    events.layout().param.watch(lambda event: written.append(event.new), "address")
    for _ in range(2):
        events.write_link("?case=II", 1)
    assert [(address["link"], address["entry"]) for address in written] == [("?case=II", 1)] * 2


def test_an_address_says_which_steps_through_the_history_it_knows(events: BrowserEvents) -> None:
    written: list[Any] = []
    events.layout().param.watch(lambda event: written.append(event.new["steps"]), "address")
    events.write_link("?case=II", 1)
    events.follow_steps(3)
    events.write_link("?case=III", 2)
    assert written == [0, 3]
