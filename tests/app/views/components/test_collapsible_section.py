"""Sections are built when they are first shown, and stand on the page only while they are shown."""

from __future__ import annotations

import panel as pn
import pytest
from bokeh.document import Document
from panel.io.state import set_curdoc

from app.views.components.collapsible_section import CollapsibleSection, Drawers, Fold, Stack


class Builds:
    """Makers of contents that record their calls."""

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


def test_a_stack_shows_one_content_under_its_head(builds: Builds) -> None:
    stack = Stack({"a": builds.maker("a"), "b": builds.maker("b")}, "stack", head=[pn.pane.HTML("head")])
    shown = []
    for name in ("a", "b", None):
        stack.show(name)
        shown.append(texts(stack.layout()))
    assert shown == [["head", "a"], ["head", "b"], ["head"]]


def test_a_content_is_built_once_and_not_before_it_is_shown(builds: Builds) -> None:
    stack = Stack({"a": builds.maker("a"), "b": builds.maker("b")}, "stack")
    assert builds.made == []
    for name in ("a", None, "a"):
        stack.show(name)
    assert builds.made == ["a"]


def test_an_empty_stack_is_invisible(builds: Builds) -> None:
    section = CollapsibleSection(builds.maker("a"), "section")
    assert not section.layout().visible
    section.open(True)
    assert section.is_open
    assert section.layout().visible
    section.open(False)
    assert not section.layout().visible


def test_the_button_of_a_fold_opens_and_closes_it(builds: Builds) -> None:
    fold = Fold("Title", builds.maker("a"))
    labels = [fold.button.label]
    for _ in range(2):
        fold.button.clicks += 1
        labels.append(fold.button.label)
    assert labels == ["▸ Title", "▾ Title", "▸ Title"]
    assert not fold.is_open


@pytest.fixture
def drawers(builds: Builds) -> Drawers:
    labels = {"a": "A", "b": "B", "plain": ""}
    return Drawers({name: (label, f"Title {name}", builds.maker(name)) for name, label in labels.items()})


def test_at_most_one_drawer_is_open(drawers: Drawers) -> None:
    drawers.buttons.value = ["a"]
    assert (drawers.shown, texts(drawers.layout())) == ("a", ["a"])
    # The browser adds the button that is pressed.
    drawers.buttons.value = ["a", "b"]
    assert (drawers.shown, texts(drawers.layout()), drawers.buttons.value) == ("b", ["b"], ["b"])


def test_pressing_its_button_again_closes_a_drawer(drawers: Drawers) -> None:
    drawers.buttons.value = ["a"]
    drawers.buttons.value = []
    assert drawers.shown is None
    assert not drawers.layout().visible


def test_a_drawer_closed_by_its_own_button_leaves_no_button_pressed(drawers: Drawers) -> None:
    drawers.show("b")
    assert drawers.buttons.value == ["b"]
    head, *_ = drawers.layout().objects
    close = next(part for part in head if isinstance(part, pn.widgets.Button))
    close.clicks += 1
    assert (drawers.shown, drawers.buttons.value) == (None, [])


def test_a_drawer_without_a_button_is_replaced_by_one_that_has(drawers: Drawers) -> None:
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
