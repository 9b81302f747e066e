"""Make random messages of Bokeh's protocol for all models of a page. Most are such as a page sends."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from typing import Any

# Values that are wrong for most properties.
HOSTILE: tuple[Any, ...] = (
    None, True, 0, -1, 3, 1e308, 10**30, {"type": "number", "value": "nan"}, {"type": "number", "value": "+inf"}, "", "x", "I",
    "½(x² + y²) − x⁴", "\x00\n\u202e<script>", "\ud800", "x" * 5000, [], [0], [1, 1], [[]], {}, {"id": "p1001"},
    {"type": "bytes", "data": "H4sI"}, {"type": "object", "name": "Slider", "id": "q1"}, {"type": "map", "entries": [["a", 1]]},
    {"type": "map", "entries": 3}, {"type": "symbol", "name": "x"}, {"type": "value", "value": 1}, {"type": "slice"},
    {"type": "ndarray", "array": {"type": "bytes", "data": "AAAA"}, "shape": [1], "dtype": "float64", "order": "little"},
    {"type": "set", "entries": [[]]},
)  # fmt: skip
FORMULAS = (
    "½(x² + y²) − x²y²", "0.5*x^2 + 0.5*y^2 - x^2*y", "½(x²+y²)−x⁴", "½(x²+y²) − x⁴ − y⁴", "x", "x^", "1/0", "½(x² + y²) − x^13",
    "((((", "0x²",
)  # fmt: skip
EVENTS = (
    "tap", "doubletap", "rangesupdate", "selectiongeometry", "button_click", "pan", "reset", "data_event", "dom_event",
    "document_ready", "connection_lost",
)  # fmt: skip
ATTRIBUTES = ("value", "value_input", "value_throttled", "active", "start", "end", "collapsed", "inner_width", "indices")
CHEAP = ("start", "end", "inner_width", "running", "step", "direction")


def find_models(part: Any) -> Iterator[dict[str, Any]]:
    """Yield the models of a serialized document or patch, with id, class name and attributes."""
    if isinstance(part, dict):
        if "id" in part and isinstance(part.get("attributes"), dict):
            yield part
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from find_models(inner)


class RandomMessages:
    """Makes random messages to a server from the models that the server has sent.

    Parameters
    ----------
    seed
        Seed of the random numbers.
    """

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.models: dict[str, dict[str, Any]] = {}

    def learn(self, content: Any) -> None:
        """Remember the models in a message of the server, and changes of attributes in the message."""
        for model in find_models(content):
            self.models[model["id"]] = model
        for event in content.get("events", ()) if isinstance(content, dict) else ():
            if event.get("kind") == "ModelChanged" and event["model"]["id"] in self.models:
                self.models[event["model"]["id"]]["attributes"][event["attr"]] = event["new"]

    def patch(self) -> dict[str, Any]:
        """Return the content of a PATCH-DOC message. Nine in ten are such as a page sends."""
        plausible = self.random.random() < 0.9
        makers = (self._plausible_change, self._plausible_event) if plausible else (self._hostile_change, self._hostile_event)
        count = 1 if plausible else self.random.randint(0, 3)
        return {"events": [self.random.choice(makers)() for _ in range(count)]}

    def wrong_parts(self) -> list[str | bytes]:
        """Return the parts of a message of another kind, of a message that is cut off, or of no message at all."""
        kind = self.random.choice(["PUSH-DOC", "PULL-DOC-REQ", "PULL-DOC-REPLY", "OK", "ERROR", "ACK", "", "x" * 300])
        usual = {"msgid": "1", "msgtype": kind}
        header: Any = self.random.choice([usual] * 8 + [None, {}, {"msgtype": kind}, {**usual, "num_buffers": 2}])
        parts: list[str | bytes] = [json.dumps(part) for part in (header, {}, {"doc": {"roots": []}})]
        match self.random.randrange(12):
            case 0:
                return parts[: self.random.randint(1, 2)]
            case 1:
                return [self.random.randbytes(20), *parts]
            case 2:
                return [parts[0], "{", "}"]
            case 3:
                return [parts[0], "{}", "[" * 50_000]
            case 4:
                return ["x" * 300_000]
        return parts

    def _plausible_change(self) -> dict[str, Any]:
        changes = list(self._plausible_changes())
        # Most changes of widgets start a computation.
        cheap = [each for each in changes if each[1] in CHEAP]
        model, name, value = self.random.choice(cheap if cheap and self.random.random() < 0.8 else changes)
        return {"kind": "ModelChanged", "model": {"id": model}, "attr": name, "new": value}

    def _plausible_changes(self) -> Iterator[tuple[str, str, Any]]:
        for model, name, attributes in self._named():
            kind = name.rpartition(".")[2]
            if "Slider" in kind:
                yield from ((model, each, self._between(attributes, "start", "end")) for each in ("value", "value_throttled"))
            elif kind == "Spinner":
                yield model, "value", self._between(attributes, "low", "high")
            elif attributes.get("labels"):
                index = self.random.randrange(len(attributes["labels"]))
                yield model, "active", [index] if "Checkbox" in kind else index
            elif attributes.get("options"):
                option = self.random.choice(list(attributes["options"]))
                yield model, "value", option[0] if isinstance(option, list) else option
            elif "TextInput" in kind:
                yield model, "value", self.random.choice(FORMULAS)
            elif kind == "Player":
                yield model, "value", self.random.randint(-1, 30)
                yield model, "direction", self.random.randint(-1, 1)
            elif kind == "Range1d":
                yield model, self.random.choice(["start", "end"]), self.random.uniform(-2.0, 2.0)
            elif kind == "Figure":
                yield model, "inner_width", self.random.randint(0, 3000)
            elif kind.startswith("BrowserEvents"):
                number = self.random.randint(0, 9)
                command = self.random.choice(["back", "forward", "copy", "h", "ArrowLeft", "+", "nothing"])
                yield model, "command", {"type": "map", "entries": [["name", command], ["number", number]]}
                link = self.random.choice(["", "?case=II", "?case=III&h=0.3&resolution=48", "?h=x&plane=q", "?" + "x" * 900])
                yield model, "address", {"type": "map", "entries": [["link", link], ["number", number]]}

    def _plausible_event(self) -> dict[str, Any]:
        waiting = [(model, each) for model, _, attributes in self._named() for each in self._subscribed(attributes)]
        model, name = self.random.choice(waiting)
        x, y = (self.random.uniform(-1.5, 1.5) for _ in range(2))
        values: dict[str, Any] = {"model": {"id": model}}
        if name in ("tap", "doubletap"):
            values |= {"sx": 9.0, "sy": 9.0, "x": x, "y": y, "modifiers": {"type": "map", "entries": [["shift", False]]}}
        elif name == "rangesupdate":
            values |= {"x0": min(x, y), "x1": max(x, y), "y0": x, "y1": y}
        elif name == "selectiongeometry":
            entries = [["type", "rect"], ["x0", x], ["x1", y], ["y0", y], ["y1", x]]
            values |= {"geometry": {"type": "map", "entries": entries}, "final": True}
        return _event(name, values)

    def _hostile_change(self) -> dict[str, Any]:
        model = self.random.choice([*self.models, "p1", ""])
        known = self.models.get(model, {}).get("attributes", ())
        name = self.random.choice([*ATTRIBUTES, *known, "nothing", "__class__", "tags", "js_event_callbacks"])
        event = {"kind": "ModelChanged", "model": {"id": model}, "attr": name, "new": self.random.choice(HOSTILE)}
        if self.random.random() < 0.2:
            event[self.random.choice(list(event))] = self.random.choice(HOSTILE)
        return event

    def _hostile_event(self) -> dict[str, Any]:
        fields = ["model", "x", "y", "x0", "x1", "geometry", "final", "data", "node", "modifiers", "sx"]
        chosen = self.random.sample(fields, self.random.randint(0, 5))
        values = {field: self.random.choice([*HOSTILE, {"id": self.random.choice(list(self.models))}]) for field in chosen}
        event = _event(self.random.choice([*EVENTS, "nothing", ""]), values)
        if self.random.random() < 0.3:
            kinds = ["RootAdded", "ColumnDataChanged", "ColumnsStreamed", "TitleChanged", "MessageSent", 3]
            event["kind"] = self.random.choice(kinds)
        return event

    def _named(self) -> Iterator[tuple[str, str, dict[str, Any]]]:
        return ((identifier, model.get("name", ""), model["attributes"]) for identifier, model in self.models.items())

    def _between(self, attributes: dict[str, Any], low: str, high: str) -> float:
        limits = [attributes.get(each) for each in (low, high)]
        first, last = (limit if isinstance(limit, int | float) else 1.0 for limit in limits)
        return self.random.uniform(first, last)

    def _subscribed(self, attributes: dict[str, Any]) -> list[str]:
        found = attributes.get("subscribed_events", ())
        return list(found.get("entries", ()) if isinstance(found, dict) else found)


def _event(name: str, values: dict[str, Any]) -> dict[str, Any]:
    entries = [list(each) for each in values.items()]
    data = {"type": "event", "name": name, "values": {"type": "map", "entries": entries}}
    return {"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": data}
