"""A browser may set widgets and plots within their limits, and send events that the server waits for."""

from __future__ import annotations

from typing import Any

import param
import pytest
from bokeh.document import Document
from bokeh.models import Button, CheckboxButtonGroup, RadioGroup, Range1d, RangeSlider, Select, Slider, Span, TextInput
from bokeh.plotting import figure
from panel.custom import JSComponent
from panel.io.state import set_curdoc
from panel.models.widgets import Player

from app.server.browser_rules import LONGEST_TEXT, OutdatedMessageError, RefusedMessageError, check_patch, find_choices


class Card(JSComponent):
    step = param.Integer(default=0, bounds=(0, 3))
    steps = param.List(default=[])
    running = param.Boolean(default=False)

    _esm = "export function render() {}"


def change(model: Any, name: str, value: Any) -> dict[str, Any]:
    return {"kind": "ModelChanged", "model": {"id": model.id}, "attr": name, "new": value}


def event(name: str, **values: Any) -> dict[str, Any]:
    data = {"type": "event", "name": name, "values": {"type": "map", "entries": [list(each) for each in values.items()]}}
    return {"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": data}


def is_accepted(document: Document, *events: Any) -> bool:
    try:
        check_patch({"events": list(events)}, document)
    except RefusedMessageError:
        return False
    return True


NAN = {"type": "number", "value": "nan"}


@pytest.mark.parametrize(
    ("model", "name", "accepted", "refused"),
    [
        (lambda: Slider(start=0, end=1, value=0.5, step=0.1), "value", [0, 0.3, 1.0], [-0.1, 1.1, NAN, "0.5", None, 10**400]),
        (lambda: RangeSlider(start=0, end=1, value=(0, 1)), "value", [[0.1, 0.2]], [[0.2, 0.1], [0.1], [0.1, 2], 0.1]),
        (lambda: Select(options=["I", ("II", "two")], value="I"), "value", ["I", "II"], ["III", "two", 1, ["I"]]),
        (lambda: TextInput(max_length=5), "value", ["", "12345"], ["123456", 1, None, "\ud800"]),
        (lambda: TextInput(), "value_input", ["x" * LONGEST_TEXT], ["x" * (LONGEST_TEXT + 1)]),
        (lambda: RadioGroup(labels=["a", "b"]), "active", [0, 1, None], [2, -1, 0.5, "a", [0], True]),
        (lambda: CheckboxButtonGroup(labels=["a", "b"]), "active", [[], [1, 0]], [[2], [0, 0], 0, None]),
        (lambda: Range1d(0, 1), "tags", [], [[], [3]]),
        (lambda: Range1d(0, 1), "start", [0.25, -3], [NAN, "x", 1e30, [1], None, 1, 2]),
        (lambda: Span(location=0.0, dimension="width"), "location", [0.25, None, NAN], ["x"]),
        (lambda: figure(), "inner_width", [300], [-1, "300", 0.5]),
        (lambda: Player(start=0, end=9, value=0), "value", [0, 9], [-1, 10, 0.5, NAN]),
        (lambda: Player(start=0, end=9, value=0), "direction", [-1, 0, 1], [2, "x"]),
        # These are not properties that a browser changes.
        (lambda: Slider(start=0, end=1, value=0.5), "end", [], [1e9]),
        (lambda: Slider(start=0, end=1, value=0.5), "nothing", [], [1]),
        (lambda: Select(options=["I"]), "options", [], [["II"]]),
        (lambda: figure(), "title", [], ["x"]),
        (lambda: TextInput(), "js_property_callbacks", [], [{}]),
    ],
)  # fmt: skip
def test_properties_take_legal_values_only(model: Any, name: str, accepted: list[Any], refused: list[Any]) -> None:
    document, widget = Document(), model()
    document.add_root(widget)
    assert [value for value in accepted if not is_accepted(document, change(widget, name, value))] == []
    assert [value for value in refused if is_accepted(document, change(widget, name, value))] == []


def test_choices_are_found_among_the_changes() -> None:
    document, choice, slider = Document(), RadioGroup(labels=["a", "b"]), Slider(start=0, end=1, value=0.5)
    for widget in (choice, slider):
        document.add_root(widget)
    assert find_choices({"events": [change(slider, "value", 0.3), change(choice, "active", 1)]}, document) == [(choice, "active")]


def test_properties_of_components_follow_their_parameters() -> None:
    document = Document()
    with set_curdoc(document):
        Card().server_doc(document)
    (data,) = (model for model in document.models if type(model).__name__.startswith("Card"))
    for name, accepted, refused in [
        ("step", [0, 3], [-1, 4, 0.5, NAN, "1", True]),
        ("running", [True], [0, "yes"]),
        ("steps", [], [[]]),
        ("name", [], ["x"]),
        ("nothing", [], [1]),
        ("tags", [], [[]]),
    ]:
        assert [value for value in accepted if not is_accepted(document, change(data, name, value))] == []
        assert [value for value in refused if is_accepted(document, change(data, name, value))] == []


@pytest.fixture
def plotted() -> tuple[Document, Any, Any]:
    document, plot, button = Document(), figure(), Button()
    document.add_root(plot)
    document.add_root(button)
    plot.on_event("tap", lambda event: None)
    button.on_event("button_click", lambda event: None)
    return document, plot, button


def test_a_model_may_be_sent_with_its_attributes(plotted: tuple[Document, Any, Any]) -> None:
    """A browser sends the attributes of models that the server has added."""
    document, _, button = plotted
    whole = {"type": "object", "name": "Button", "attributes": {"label": {"type": "bytes", "data": "H4sI"}}}
    with pytest.warns(UserWarning, match="already known"):
        assert is_accepted(document, event("button_click", model={"id": button.id, **whole}))
    assert not is_accepted(document, event("button_click", model={"id": "new", **whole}))


RECTANGLE = {"type": "rect", "x0": 0.0, "x1": 1.0, "y0": -1.0, "y1": 1.0}


@pytest.mark.parametrize(
    ("geometry", "accepted"),
    [(RECTANGLE, True), ({**RECTANGLE, "y1": "1"}, False), ({"type": "poly", "x": [0.0]}, False), ([0.0], False), (None, False)],
)
def test_a_selection_is_a_rectangle(geometry: Any, accepted: bool) -> None:
    document, plot = Document(), figure()
    document.add_root(plot)
    plot.on_event("selectiongeometry", lambda event: None)
    sent = {"type": "map", "entries": [list(each) for each in geometry.items()]} if isinstance(geometry, dict) else geometry
    assert is_accepted(document, event("selectiongeometry", model={"id": plot.id}, geometry=sent, final=True)) == accepted


POINT = {"sx": 1, "sy": 1, "x": 0.5, "y": 0.5, "modifiers": {"shift": False}}


def test_events_that_the_server_waits_for_are_accepted(plotted: tuple[Document, Any, Any]) -> None:
    document, plot, button = plotted
    assert is_accepted(document, event("tap", model={"id": plot.id}, **POINT))
    assert is_accepted(document, event("button_click", model={"id": button.id}))
    assert is_accepted(document, event("document_ready"))


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("tap", {**POINT, "x": NAN}),
        ("tap", {**POINT, "x": None}),
        ("tap", {**POINT, "more": 1}),
        ("tap", {"x": 1}),
        ("pan", POINT),
        ("button_click", {}),
        ("no_event", {}),
        ("connection_lost", {}),
    ],
)
def test_other_events_are_refused(plotted: tuple[Document, Any, Any], name: str, values: dict[str, Any]) -> None:
    document, plot, _ = plotted
    assert not is_accepted(document, event(name, model={"id": plot.id}, **values))


@pytest.mark.parametrize(
    "content",
    [
        None,
        [],
        {},
        {"events": {}},
        {"events": [1]},
        {"events": [{"kind": "RootAdded", "model": {"id": "1"}}]},
        {"events": [{"kind": "ModelChanged", "model": {"id": "p1"}, "attr": "value", "new": 1}]},
        {"events": [{"kind": "ModelChanged", "model": {"id": ["1"]}, "attr": "value", "new": 1}]},
        {"events": [event("document_ready")], "references": []},
        # Decompressed, this would be larger than the memory.
        {"events": [{"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": {"type": "bytes", "data": "H4sI"}}]},
        {"events": [event("document_ready")] * 2000},
    ],
)
def test_other_messages_are_refused(content: Any) -> None:
    with pytest.raises(RefusedMessageError):
        check_patch(content, Document())


def test_deeply_nested_values_are_refused() -> None:
    nested: Any = 1
    for _ in range(500):
        nested = [nested]
    with pytest.raises(RefusedMessageError):
        check_patch({"events": [nested]}, Document())


def test_both_ends_of_a_range_may_change_at_once() -> None:
    document, changed = Document(), Range1d(0, 1)
    document.add_root(changed)
    assert is_accepted(document, change(changed, "start", 5), change(changed, "end", 6))
    assert not is_accepted(document, change(changed, "start", 6), change(changed, "end", 5))


def test_messages_about_removed_models_are_outdated() -> None:
    document, removed = Document(), Slider(start=0, end=1, value=0)
    document.add_root(removed)
    document.remove_root(removed)
    with pytest.raises(OutdatedMessageError):
        check_patch({"events": [change(removed, "value", 1)]}, document)


def test_one_bad_event_refuses_the_whole_message(plotted: tuple[Document, Any, Any]) -> None:
    document, plot, button = plotted
    good = event("button_click", model={"id": button.id})
    assert is_accepted(document, good)
    assert not is_accepted(document, good, change(plot, "title", "x"))
