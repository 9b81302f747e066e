"""The server's side of the box for a formula; tests/browser/test_potentials_in_browser.py has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.formula_box import LONGEST_TYPED, FormulaBox


@pytest.fixture
def typed() -> list[tuple[str, bool]]:
    return []


@pytest.fixture
def box(typed: list[tuple[str, bool]]) -> FormulaBox:
    return FormulaBox(lambda text, done: typed.append((text, done)))


def test_each_text_is_reported(box: FormulaBox, typed: list[tuple[str, bool]]) -> None:
    box._receive({"text": "x", "typed": 1, "done": False})
    box._receive({"text": "x²", "typed": 2, "done": True})
    assert typed == [("x", False), ("x²", True)]
    assert box.text == "x²"


def test_a_text_is_sent_with_the_count_of_those_typed_before(box: FormulaBox) -> None:
    box._receive({"text": "x", "typed": 1, "done": False})
    box.show("y")
    assert box.shown == {"text": "y", "typed": 1}


@pytest.mark.parametrize(
    "message",
    [
        None,
        "x",
        {"text": "x", "typed": 1},
        {"text": 1, "typed": 1, "done": True},
        {"text": "x", "typed": "1", "done": True},
        {"text": "x" * (LONGEST_TYPED + 1), "typed": 1, "done": True},
    ],
)
def test_other_messages_are_ignored(box: FormulaBox, typed: list[tuple[str, bool]], message: Any) -> None:
    box._receive(message)
    assert (typed, box.text) == ([], "")
