"""Legal messages from components in the browser are reported, and all others are ignored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import pytest
from panel.custom import JSComponent

from app.browser.components.file_components import ImageCopier
from app.browser.components.orbit_components import OrbitList, OrbitPlayer
from app.browser.inputs.counted_inputs import (
    LONGEST_TYPED,
    FormulaBox,
    NumberBox,
    ParameterSliders,
    SliderParameter,
)
from app.state.view_state import ViewState
from app.views.panels.browser_events import KEYS, BrowserEvents
from app.views.panels.engine_component import BrowserEngine
from app.views.panels.gallery import Gallery
from engine import Window
from plots.links.presets import PRESETS
from tests.app.browser_messages import send
from tests.app.map_actions import make_browser_engine

Report = Callable[..., None]
NAN = float("nan")
EDGES = {"xLow": -0.1, "xHigh": 0.1, "ordinateLow": 0.2, "ordinateHigh": 0.4}
# Messages that are wrong for every component.
NEVER = [None, 7, "x", [], {}, {"other": 1}]


@dataclass(frozen=True)
class Example:
    """A component, legal messages with what they report, and messages that are ignored."""

    make: Callable[[Report], JSComponent]
    legal: list[tuple[Any, tuple[Any, ...]]]
    ignored: list[Any] = field(default_factory=list)


def make_engine(report: Report) -> BrowserEngine:
    engine = make_browser_engine(ViewState(energy=0.2))
    engine.play()
    engine.param.watch(lambda event: report(event.new), "playing")
    return engine


def make_energy(report: Report) -> JSComponent:
    state = ViewState(energy=0.2)
    state.param.watch(lambda event: report(event.new), "energy")
    return make_browser_engine(state)


def make_windows(report: Report) -> JSComponent:
    return make_browser_engine(on_zoom=report, on_rest=lambda: report("rest"))


def make_events(report: Report) -> JSComponent:
    def named(name: str) -> Report:
        return lambda *values: report(name, *values)

    state = ViewState()
    for name in ("touch", "narrow", "focus"):
        state.param.watch(lambda event: report(event.name, event.new), name)
    return BrowserEvents(state, KEYS, lambda call: call, *map(named, ("key", "navigate", "copied")))


def make_player(report: Report) -> JSComponent:
    return OrbitPlayer(report, begin=5.0, end=12.5)


def given(value: Any, count: Any = 1, *, done: bool = True) -> dict[str, Any]:
    """Return the message of an input to which the visitor gives a value."""
    return {"value": value, "count": count, "done": done}


def make_sliders(report: Report) -> ParameterSliders:
    sliders = ParameterSliders(report)
    parameters = SliderParameter("epsilon", "ε", 0.2, 2.0, 0.1, 10.0), SliderParameter("a", "a", -2.0, 2.0, -9.0, 9.0)
    sliders.show(dict(zip(parameters, (1.0, 0.5), strict=True)))
    return sliders


def shown_numbers(sliders: ParameterSliders) -> dict[str, tuple[float, int]]:
    """Return the shown number of each slider, and the count of numbers received before."""
    return {row["name"]: (row["value"], row["count"]) for row in sliders.rows}


EXAMPLES = {
    "number box": Example(
        lambda report: NumberBox(report, 0.19),
        [(given(0.3), (0.3,)), (given(1, 2), (1.0,))],
        [{"value": 0.3}, {"value": 0.3, "count": 1}, given("0.3"), given(NAN), given(0.3, "1")],
    ),
    "formula box": Example(
        lambda report: FormulaBox(report, ""),
        [(given("x", done=False), ("x", False)), (given("x" * LONGEST_TYPED, 2), ("x" * LONGEST_TYPED, True))],
        [given(1), given("x" * (LONGEST_TYPED + 1))],
    ),
    "sliders of parameters": Example(
        make_sliders,
        [
            ({"name": "epsilon", **given(1.13, done=False)}, ("epsilon", 1.13, False)),
            ({"name": "a", **given(-9)}, ("a", -9.0, True)),
            ({"name": "epsilon", **given(10, 2)}, ("epsilon", 10.0, True)),
        ],
        [
            *({"name": "epsilon", **given(number)} for number in ("1", NAN, 0.05, 11.0)),
            *({"name": name, **given(1.0)} for name in ("b", 7, None)),
            given(1.0),
        ],
    ),
    "energy of the store": Example(
        make_energy,
        [({"name": "energy", **given(0.25)}, (0.25,)), ({"name": "energy", **given(17, 2)}, (17.0,))],
        [given(0.3, 3), *({"name": "energy", **given(energy, 3)} for energy in ("0.3", NAN, float("inf"), None, [0.3]))],
    ),
    "windows of the store": Example(
        make_windows,
        [
            ({"name": "window", **given(EDGES, done=False)}, (Window(-0.1, 0.1, 0.2, 0.4),)),
            ({"gesture": "end"}, ("rest",)),
        ],
        [
            {"gesture": 1},
            {"name": "window", **given(EDGES, "3")},
            *({"name": "window", **given(value, 3)} for value in (None, 0.3, [-0.1, 0.1, 0.2, 0.4])),
            *({"name": "window", **given(EDGES | {"xLow": value}, 3)} for value in (NAN, 0.2, "x", [])),
        ],
    ),
    "end of playing, once": Example(make_engine, [({"playing": False}, (False,))], [{"playing": False}, {"playing": True}]),
    "button that copies an image": Example(
        lambda report: ImageCopier(lambda: report("wanted"), report),
        [({"wanted": True}, ("wanted",)), ({"copied": True}, (True,)), ({"copied": False}, (False,))],
        [{"wanted": 1}, {"copied": "yes"}, {"image": None}],
    ),
    "list of orbits": Example(
        lambda report: OrbitList(report, rows=["first", "second"]),
        [({"chosen": 1}, (1,)), ({"chosen": 0}, (0,))],
        [{"chosen": place} for place in (-1, 2, 0.5, True, "1")],
    ),
    "player of orbits": Example(
        make_player,
        # JavaScript has one type of numbers: 5.0 arrives as 5.
        [({"step": step, "begin": 5, "end": 12.5}, (time,)) for step, time in ((0, None), (240, 8.0), (600, 12.5))],
        [
            {"step": 3},
            *({"step": step, "begin": 5, "end": 12.5} for step in (3.5, -1, 601)),
            {"step": 3, "begin": 0, "end": 12.5},
            {"step": 3, "begin": 5, "end": "12.5"},
        ],
    ),
    "player without an interval": Example(
        lambda report: OrbitPlayer(report, begin=0.0, end=0.0), [], [{"step": 3, "begin": 0, "end": 0}]
    ),
    "gallery": Example(
        lambda report: Gallery(ViewState(), report, lambda: report("tour")).build()[0],
        [(PRESETS[1].key, (PRESETS[1],)), ("tour", ("tour",))],
        ["no such key", [PRESETS[0].key], {PRESETS[0].key: 1}],
    ),
    "keys and history": Example(
        make_events,
        [
            ({"key": "h"}, ("key", "h")),
            ({"link": "?case=II", "entry": 3, "steps": 1}, ("navigate", "?case=II", 3, 1)),
            ({"touch": True}, ("touch", True)),
            ({"narrow": True}, ("narrow", True)),
            ({"copied": False}, ("copied", False)),
            ({"enlarge": "times"}, ("focus", "times")),
        ],
        [{"key": "x"}, {"key": 7}, {"touch": False}, {"link": 7, "entry": 1, "steps": 1}],
    ),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_legal_messages_are_reported_and_all_others_ignored(name: str) -> None:
    example, reported = EXAMPLES[name], list[tuple[Any, ...]]()
    component = example.make(lambda *values: reported.append(values))
    send(component, *(message for message, _ in example.legal), *NEVER, *example.ignored)
    assert reported == [expected for _, expected in example.legal]


def test_values_of_the_server_carry_the_count_of_values_given_before() -> None:
    box = NumberBox(lambda *_: None, 0.19)
    send(box, given(1.13, 3))
    box.show(0.25)
    assert box.shown == {"value": 0.25, "count": 3}


def test_a_refused_value_is_counted_so_that_the_browser_shows_the_previous_value_again() -> None:
    box = NumberBox(lambda *_: None, 0.19)
    send(box, given(1.13), given(NAN, 2))
    assert box.shown == {"value": 1.13, "count": 2}


def test_each_slider_counts_its_own_numbers_and_goes_on_when_it_is_shown_again() -> None:
    sliders = make_sliders(lambda *_: None)
    send(sliders, {"name": "a", **given(1.5, 3)})
    assert shown_numbers(sliders) == {"epsilon": (1.0, 0), "a": (1.5, 3)}
    parameter = SliderParameter("a", "a", -4.0, 4.0, -9.0, 9.0)
    sliders.show({})
    sliders.show({parameter: 2.5})
    assert shown_numbers(sliders) == {"a": (2.5, 3)}


def test_a_refused_number_is_counted_so_that_the_slider_shows_the_previous_number_again() -> None:
    sliders = make_sliders(lambda *_: None)
    send(sliders, *({"name": "epsilon", **given(*numbers)} for numbers in ((1.13, 1), (11.0, 2))))
    assert shown_numbers(sliders) == {"epsilon": (1.13, 2), "a": (0.5, 0)}


def test_repeated_commands_differ() -> None:
    engine, commands = make_engine(lambda *_: None), []
    for _ in range(2):
        engine.stop()
        commands.append(engine.command)
    assert commands[0] != commands[1]
