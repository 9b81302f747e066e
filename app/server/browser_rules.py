"""The changes that a browser may make on the server: values of widgets, ranges and sizes of plots, and events of models.

Bokeh checks only the types of properties, and Panel checks values only in callbacks. Either answers an invalid value with a
traceback in the log. Here the whole message is checked before Bokeh gets it.
"""

from __future__ import annotations

import reprlib
from collections import defaultdict
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from typing import Any

import param
from bokeh.core.serialization import DeserializationError, Deserializer, UnknownReferenceError
from bokeh.document import Document
from bokeh.events import DocumentReady, ModelEvent, SelectionGeometry
from bokeh.model import DataModel, Model
from bokeh.models import (
    AbstractGroup,
    AbstractSlider,
    Checkbox,
    CheckboxGroup,
    Plot,
    RadioGroup,
    Range1d,
    Select,
    Selection,
    Span,
    Switch,
    Tabs,
    TextInput,
    Toggle,
)
from panel.custom import JSComponent
from panel.models.layout import Card, Column
from panel.models.widgets import Player

LONGEST_TEXT = 4000
"""Largest length of any text in a message, in characters."""

MOST_VALUES = 2000
"""Largest number of values in a message, including nested values."""

# Largest absolute value of a number in a message.
_LARGEST_NUMBER = 1e15
# Largest depth of nested values.
_LARGEST_DEPTH = 12

Check = Callable[[Model, Any], bool]
"""Function that returns whether a browser may give a value to a property of a model."""


class RefusedMessageError(ValueError):
    """A message that no page sends. Its text says what is wrong."""


class OutdatedMessageError(RefusedMessageError):
    """A message about a model that the server has removed since the browser sent the message."""


def find_choices(content: Any, document: Document) -> list[tuple[Model, str]]:
    """Return the switches, radio buttons and lists that a checked PATCH-DOC message changes, with the changed properties."""
    events = (event for event in content["events"] if event["kind"] == "ModelChanged")
    changes = ((document.models.get_by_id(event["model"]["id"]), event["attr"]) for event in events)
    return [(model, name) for model, name in changes if isinstance(model, _CHOICE_MODELS)]


def check_patch(content: Any, document: Document) -> None:
    """Check the content of a PATCH-DOC message.

    Parameters
    ----------
    content
        Content of the message, parsed from JSON.
    document
        The document that the message would change.

    Raises
    ------
    RefusedMessageError
        If the page cannot have sent the message.
    """
    if not isinstance(content, dict) or content.keys() != {"events"} or not isinstance(content["events"], list):
        raise RefusedMessageError("a patch must have a list of events")
    models = {model.id: model for model in document.models}
    _check_values(content["events"], models)
    decoder = Deserializer(list(models.values()))
    ranges: dict[Range1d, dict[str, Any]] = defaultdict(dict)
    for event in content["events"]:
        match event:
            case {"kind": "ModelChanged", "model": {"id": str()}, "attr": str(name), "new": value, **rest} if not rest:
                model, new = _decode(document, decoder, event["model"]), _decode(document, decoder, value)
                _check_change(model, name, new)
                if isinstance(model, Range1d):
                    ranges[model][name] = new
            case {"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": data, **rest} if not rest:
                _check_event(_decode(document, decoder, data))
            case _:
                raise RefusedMessageError(f"an event {_quote(event)} that no page sends")
    for changed_range, values in ranges.items():
        _check_range(changed_range, **values)


def _decode(document: Document, decoder: Deserializer, value: Any) -> Any:
    """Return a value as a Python object. Refuse unknown models, unknown classes and wrong fields."""
    try:
        return decoder.decode(value)
    except UnknownReferenceError as error:
        if isinstance(error.id, str) and document.models.seen(error.id):
            raise OutdatedMessageError(f"the model {_quote(error.id)} is no longer there") from None
        raise RefusedMessageError(f"there is no model {_quote(error.id)}") from None
    except (DeserializationError, TypeError, ValueError, KeyError, AttributeError) as error:
        # Bokeh raises any of these for an unknown class or a wrong field.
        raise RefusedMessageError(f"{_quote(value)} cannot be decoded: {_quote(str(error))}") from None


def _check_range(changed_range: Range1d, **values: float) -> None:
    """Refuse values of a range, of one end or both, that would make the range empty or reverse its direction."""
    start, end = values.get("start", changed_range.start), values.get("end", changed_range.end)
    if (end - start) * (changed_range.end - changed_range.start) <= 0.0:
        raise RefusedMessageError(f"a range from {start} to {end}")


def _check_change(model: Model, name: str, value: Any) -> None:
    """Refuse a change of a property that no browser changes, or to a value that the property must not have."""
    place = f"{type(model).__name__}.{name}"
    checks = _checks_of(model, name)
    if not checks or name not in model.properties():
        raise RefusedMessageError(f"{place} is not a property that a browser changes")
    if not model.lookup(name).property.is_valid(value) or not all(check(model, value) for check in checks):
        raise RefusedMessageError(f"{place} cannot be {_quote(value)}")


def _checks_of(model: Model, name: str) -> list[Check]:
    """Return the checks of a property; none if a browser must not change the property."""
    # Every Bokeh model has the properties name and tags, which are no parameters of the component.
    if isinstance(model, DataModel) and name not in ("name", "tags"):
        return [lambda model, value: _is_parameter_value(model, name, value)]
    return [checks[name] for kind, checks in _EDITABLE.items() if isinstance(model, kind) and name in checks]


def _check_event(event: Any) -> None:
    """Refuse an event without a subscriber on the server, or with coordinates that are not numbers."""
    if isinstance(event, DocumentReady):
        return
    if not isinstance(event, ModelEvent) or not isinstance(event.model, Model):
        raise RefusedMessageError(f"an event {_quote(event)} that no page sends")
    name = f"event {event.event_name} of {type(event.model).__name__}"
    if event.event_name not in event.model.subscribed_events:
        raise RefusedMessageError(f"{name}: nothing on the server waits for it")
    if not all(_is_real(getattr(event, field)) for field in _EVENT_COORDINATES if hasattr(event, field)):
        raise RefusedMessageError(f"{name}: its coordinates must be numbers")
    if isinstance(event, SelectionGeometry) and not _is_rectangle(event.geometry):
        raise RefusedMessageError(f"{name}: its geometry must be a rectangle")


def _is_rectangle(geometry: Any) -> bool:
    return isinstance(geometry, Mapping) and all(_is_real(geometry.get(edge)) for edge in _EDGES)


# Numeric fields of the events of plots.
_EDGES = ("x0", "x1", "y0", "y1")
_EVENT_COORDINATES = ("x", "y", "sx", "sy", *_EDGES)


def _check_values(events: Any, known: Container[str]) -> None:
    """Refuse too many, too deep or too large values, and values of types that no page sends."""
    for index, (depth, value) in enumerate(_walk(events, 0, known)):
        if index == MOST_VALUES or depth > _LARGEST_DEPTH:
            raise RefusedMessageError("a patch with too many or too deeply nested values")
        if not _is_plain(value):
            raise RefusedMessageError(f"a patch with the value {_quote(value)}")


def _walk(value: Any, depth: int, known: Container[str]) -> Iterator[tuple[int, Any]]:
    """Yield a value and all values in it, with their depths, except the models whose ids are in `known`.

    Bokeh ignores the attributes of these models. A browser that first refers to a model added by the server sends all attributes
    of the model, and not only its id.
    """
    if isinstance(value, dict) and value.get("type") == "object" and isinstance(value.get("id"), str) and value["id"] in known:
        return
    yield depth, value
    children: Iterable[Any] = ()
    if depth <= _LARGEST_DEPTH and isinstance(value, dict):
        children = (*value.keys(), *value.values())
    elif depth <= _LARGEST_DEPTH and isinstance(value, list):
        children = value
    for child in children:
        yield from _walk(child, depth + 1, known)


def _is_plain(value: Any) -> bool:
    """Whether a value, without the values in it, is of a kind and size that a page sends."""
    if isinstance(value, str):
        # A lone surrogate cannot be encoded.
        return len(value) <= LONGEST_TEXT and not any("\ud800" <= c <= "\udfff" for c in value)
    if isinstance(value, int | float):
        return _is_real(value)
    return not isinstance(value, dict) or value.get("type", "map") in ("map", "event", "number")


def _is_real(value: Any) -> bool:
    """Whether a value is a number of at most `_LARGEST_NUMBER`. NaN is not: its comparison is False."""
    return isinstance(value, int | float) and abs(value) <= _LARGEST_NUMBER


def _quote(value: Any) -> str:
    return reprlib.repr(value)


def _is_between(value: Any, low: Any, high: Any) -> bool:
    """Whether a value is a number, but no boolean, within two limits; None stands for no limit."""
    return _is_real(value) and not isinstance(value, bool) and (low is None or low <= value) and (high is None or value <= high)


def _is_on_slider(slider: Any, value: Any) -> bool:
    values = list(value) if isinstance(value, list | tuple) else [value]
    return all(_is_between(each, slider.start, slider.end) for each in values) and values == sorted(values)


def _is_option(select: Any, value: Any) -> bool:
    options = select.options
    groups = options.values() if isinstance(options, Mapping) else [options]
    return any(value == (option[0] if isinstance(option, tuple | list) else option) for group in groups for option in group)


def _is_active(group: Any, value: Any) -> bool:
    active_indices = value if isinstance(value, list) else [] if value is None else [value]
    return len(set(active_indices)) == len(active_indices) and all(
        _is_between(each, 0, len(group.labels) - 1) for each in active_indices
    )


def _is_short(box: Any, value: Any) -> bool:
    return len(value) <= (LONGEST_TEXT if box.max_length is None else box.max_length)


def _is_boolean(_: Any, value: Any) -> bool:
    return isinstance(value, bool)


def _is_position(_: Any, value: Any) -> bool:
    """Whether a value is a position on an axis; NaN stands for a pointer outside the plot."""
    return value is None or isinstance(value, int | float)


def _between(low: Any, high: Any) -> Check:
    """Return a check whether a value is a number within two limits."""
    return lambda _, value: _is_between(value, low, high)


def _is_nonnegative_list(_: Any, value: Any) -> bool:
    """Whether all values of a list are numbers of at least 0."""
    return all(_is_between(each, 0, None) for each in value)


def _is_parameter_value(model: DataModel, name: str, value: Any) -> bool:
    """Whether a value is legal for the parameter of a component, given the component's data model and the parameter's name."""
    # Panel offers no public way from a data model to the component class.
    owners = (each for each in param.concrete_descendents(JSComponent).values() if each._data_model is type(model))
    parameter = next((owner.param[name] for owner in owners if name in owner.param), None)
    match parameter:
        case param.Number():
            low, high = parameter.bounds or (None, None)
            is_right_type = isinstance(value, int) or not isinstance(parameter, param.Integer)
            return is_right_type and _is_between(value, low, high)
        case param.Boolean():
            return isinstance(value, bool)
        case param.String() | param.Dict():
            return True
    return False


# Widgets whose changes the server sends back to the browser, see `app.server.page_websocket`.
_CHOICE_MODELS = (CheckboxGroup, RadioGroup, Select)


_EDITABLE: dict[type[Model], Mapping[str, Check]] = {
    AbstractSlider: {"value": _is_on_slider, "value_throttled": _is_on_slider},
    TextInput: {"value": _is_short, "value_input": _is_short},
    Select: {"value": _is_option},
    AbstractGroup: {"active": _is_active},
    Toggle: {"active": _is_boolean},
    Checkbox: {"active": _is_boolean},
    Switch: {"active": _is_boolean},
    Tabs: {"active": lambda tabs, value: _is_between(value, 0, len(tabs.tabs) - 1)},
    Player: {"value": _is_on_slider, "value_throttled": _is_on_slider, "direction": _between(-1, 1)},
    Card: {"collapsed": _is_boolean},
    Column: {"scroll_position": _between(0, None)},
    Range1d: dict.fromkeys(("start", "end"), _between(None, None)),
    Span: {"location": _is_position},
    Plot: dict.fromkeys(("inner_width", "inner_height", "outer_width", "outer_height"), _between(0, None)),
    Selection: {"indices": _is_nonnegative_list, "line_indices": _is_nonnegative_list},
}
"""Properties that a browser may change, each with a check of its value, by class of model. The checks also apply to subclasses.
`_checks_of` adds the parameters of components."""
