"""Each turn of the event loop makes one part of the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import panel as pn
import pytest

from app.views.components.collapsible_section import InTurns


class Page:
    """Collects the parts that are added to it, and the calls for later turns of the event loop."""

    def __init__(self) -> None:
        self.turns: list[Callable[[], None]] = []
        self.texts: list[str] = []

    def add(self, parts: Sequence[pn.viewable.Viewable]) -> None:
        self.texts += [part.object for part in parts]

    def later(self, call: Callable[[], None]) -> Callable[[], None]:
        return lambda: self.turns.append(call)


@pytest.fixture
def page() -> Page:
    return Page()


def make(name: str) -> list[pn.viewable.Viewable]:
    return [pn.pane.HTML(name)]


def fail() -> list[pn.viewable.Viewable]:
    raise OSError("a full disk")


def test_each_part_has_a_turn_of_its_own_and_is_made_once(page: Page) -> None:
    parts = InTurns([partial(make, name) for name in "abc"], page.add, page.later)
    assert not page.turns
    parts.begin()
    parts.begin()
    counts = []
    while page.turns:
        page.turns.pop(0)()
        counts.append(len(page.texts))
    assert page.texts == ["a", "b", "c"]
    assert counts[:3] == [1, 2, 3]


def test_an_error_in_one_part_does_not_prevent_the_others(page: Page) -> None:
    InTurns([fail, partial(make, "b")], page.add, page.later).begin()
    with pytest.raises(OSError, match="a full disk"):
        page.turns.pop(0)()
    page.turns.pop(0)()
    assert page.texts == ["b"]
