"""The server's side of the list of orbits; tests/browser/test_orbits_in_browser.py has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.orbit_list import OrbitList


@pytest.fixture
def chosen() -> list[int]:
    return []


@pytest.fixture
def orbits(chosen: list[int]) -> OrbitList:
    return OrbitList(chosen.append, rows=["first", "second"])


def test_the_row_that_is_chosen_is_reported(orbits: OrbitList, chosen: list[int]) -> None:
    for place in (1, 0):
        orbits._receive({"chosen": place})
    assert chosen == [1, 0]


@pytest.mark.parametrize(
    "message", [None, 1, {}, {"chosen": -1}, {"chosen": 2}, {"chosen": 0.5}, {"chosen": True}, {"chosen": "1"}]
)
def test_other_messages_are_ignored(orbits: OrbitList, chosen: list[int], message: Any) -> None:
    orbits._receive(message)
    assert chosen == []
