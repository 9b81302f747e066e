"""Each turn of the event loop makes one part of the page."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import panel as pn
import pytest

from app.views.components.collapsible_section import InTurns


def make(name: str) -> list[pn.viewable.Viewable]:
    return [pn.pane.HTML(name)]


def test_each_part_has_a_turn_of_its_own_and_is_made_once() -> None:
    turns: list[Callable[[], None]] = []
    made: list[str] = []

    def later(call: Callable[[], None]) -> Callable[[], None]:
        return lambda: turns.append(call)

    parts = InTurns([partial(make, name) for name in "abc"], lambda added: made.extend(part.object for part in added), later)
    assert not turns
    parts.begin()
    parts.begin()
    counts = []
    while turns:
        turns.pop(0)()
        counts.append(len(made))
    assert made == ["a", "b", "c"]
    assert counts[:3] == [1, 2, 3]


def test_an_error_in_one_part_does_not_prevent_the_others() -> None:
    turns: list[Callable[[], None]] = []
    made: list[str] = []

    def fail() -> list[pn.viewable.Viewable]:
        raise OSError("a full disk")

    def later(call: Callable[[], None]) -> Callable[[], None]:
        return lambda: turns.append(call)

    parts = InTurns([fail, partial(make, "b")], lambda added: made.extend(part.object for part in added), later)
    parts.begin()
    with pytest.raises(OSError, match="a full disk"):
        turns.pop(0)()
    turns.pop(0)()
    assert made == ["b"]
