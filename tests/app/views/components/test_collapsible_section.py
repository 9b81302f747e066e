"""Sections are built when first shown, and are on the page only while shown."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn
import pytest
from bokeh.document import Document
from panel.io.state import set_curdoc

from app.views.components.collapsible_section import Drawers, Stack


class Builds:
    """Makes contents of sections, and records the calls."""

    def __init__(self) -> None:
        self.made: list[str] = []

    def maker(self, name: str):
        def make() -> list[pn.viewable.Viewable]:
            self.made.append(name)
            return [pn.pane.HTML(name)]

        return make


@pytest.fixture
def builds() -> Builds:
    return Builds()


def texts(column: pn.Column) -> list[str]:
    return [part.object for part in column.objects if isinstance(part, pn.pane.HTML)]


def test_a_stack_shows_one_content_under_its_head_built_once(builds: Builds) -> None:
    stack = Stack({name: [builds.maker(name)] for name in "ab"}, "stack", head=[pn.pane.HTML("head")])
    assert builds.made == []
    shown = []
    for name in ("a", "b", None, "a"):
        stack.show(name)
        shown.append(texts(stack.layout()))
    assert shown == [["head", "a"], ["head", "b"], ["head"], ["head", "a"]]
    assert builds.made == ["a", "b"]


def test_the_other_parts_of_a_content_follow_in_turns_while_the_content_is_shown(builds: Builds) -> None:
    turns = list[Callable[[], None]]()
    makes = {"long": [builds.maker(name) for name in "abc"], "short": [builds.maker("d")]}
    stack = Stack(makes, "stack", later=lambda call: lambda: turns.append(call))
    stack.show("long")
    shown = [texts(stack.layout())]
    for name in ("long", "short"):
        turns.pop(0)()
        stack.show(name)
        shown.append(texts(stack.layout()))
    stack.show("long")
    assert [*shown, texts(stack.layout())] == [["a"], ["a", "b"], ["d"], ["a", "b", "c"]]


@pytest.fixture
def drawers(builds: Builds) -> Drawers:
    labels = {"a": "A", "b": "B", "plain": ""}
    return Drawers({name: (label, f"Title {name}", [builds.maker(name)]) for name, label in labels.items()})


def test_a_drawer_without_a_button_is_replaced_by_a_drawer_with_a_button(drawers: Drawers) -> None:
    drawers.buttons.value = ["a"]
    drawers.show("plain")
    assert (drawers.shown, drawers.buttons.value) == ("plain", [])
    drawers.buttons.value = ["b"]
    assert drawers.shown == "b"


def test_a_drawer_and_its_button_change_in_one_message(drawers: Drawers) -> None:
    document, held = Document(), list[str | None]()
    for part, name in ((drawers.layout(), "objects"), (drawers.buttons, "value")):
        part.param.watch(lambda event: held.append(document.callbacks.hold_value), name)
    with set_curdoc(document):
        drawers.show("a")
    assert held == ["combine", "combine"]
    assert document.callbacks.hold_value is None
