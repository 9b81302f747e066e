"""The server's side of a slider of a parameter; tests/browser/test_potentials_in_browser.py has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.parameter_slider import ParameterSlider


@pytest.fixture
def chosen() -> list[tuple[float, bool]]:
    return []


@pytest.fixture
def slider(chosen: list[tuple[float, bool]]) -> ParameterSlider:
    return ParameterSlider(lambda number, done: chosen.append((number, done)), low=0.2, high=2.0, lowest=0.1, highest=10.0)


def test_each_number_is_reported(slider: ParameterSlider, chosen: list[tuple[float, bool]]) -> None:
    slider._receive({"number": 1.13, "chosen": 1, "done": False})
    slider._receive({"number": 3, "chosen": 2, "done": True})
    assert chosen == [(1.13, False), (3.0, True)]


def test_a_number_is_sent_with_the_count_of_those_chosen_before(slider: ParameterSlider) -> None:
    slider._receive({"number": 1.13, "chosen": 1, "done": False})
    slider.show(1.0)
    assert slider.shown == {"number": 1.0, "chosen": 1}


@pytest.mark.parametrize(
    "message",
    [
        None,
        1.0,
        {"number": 1.0, "chosen": 1},
        {"number": "1", "chosen": 1, "done": True},
        {"number": float("nan"), "chosen": 1, "done": True},
        {"number": 0.05, "chosen": 1, "done": True},
        {"number": 11.0, "chosen": 1, "done": True},
    ],
)
def test_other_messages_are_ignored(slider: ParameterSlider, chosen: list[tuple[float, bool]], message: Any) -> None:
    slider._receive(message)
    assert (chosen, slider.shown["number"]) == ([], 1.0)
