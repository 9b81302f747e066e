"""The server's side of a number box; tests/browser/test_energy_in_browser.py has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.number_box import NumberBox


@pytest.fixture
def typed() -> list[float]:
    return []


@pytest.fixture
def box(typed: list[float]) -> NumberBox:
    return NumberBox(typed.append, 0.19)


def test_typed_numbers_are_reported(box: NumberBox, typed: list[float]) -> None:
    box._receive({"number": 0.3, "typed": 1})
    box._receive({"number": 1, "typed": 2})
    assert typed == [0.3, 1.0]


def test_a_number_is_sent_with_the_count_of_those_typed_before(box: NumberBox) -> None:
    box.show(0.25)
    assert box.shown == {"number": 0.25, "typed": 0}
    box._receive({"number": 0.3, "typed": 1})
    box.show(0.35)
    assert box.shown == {"number": 0.35, "typed": 1}


@pytest.mark.parametrize(
    "message", [None, 7, {}, {"number": 0.3}, {"number": "0.3", "typed": 1}, {"number": float("nan"), "typed": 1}]
)
def test_other_messages_are_ignored(box: NumberBox, typed: list[float], message: Any) -> None:
    box._receive(message)
    assert typed == []
