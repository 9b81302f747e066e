"""The progress line names the resolution, the time reached and the undecided share."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.views.components.progress import CONTINUE, STOP, ProgressView
from engine import CASES, EscapeMap, MapSpec, Plane, compute_map


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e3))


def make_view() -> tuple[ProgressView, list[str]]:
    calls: list[str] = []
    return ProgressView(lambda: calls.append("cancel"), lambda: calls.append("resume")), calls


def test_a_complete_map_gives_its_shares(escape_map: EscapeMap) -> None:
    view, _ = make_view()
    view.show(escape_map)
    assert view.text.object.startswith("Done, t = 1 000. Interior starts: channel 1 ")
    assert (view.bar.styles["opacity"], view.button.styles["visibility"]) == ("0", "hidden")


def test_a_map_in_progress_gives_time_and_undecided_share(escape_map: EscapeMap) -> None:
    view, _ = make_view()
    view.show(replace(escape_map, horizon=100.0, complete=False))
    assert view.text.object.startswith("Full resolution, t = 100 of 1 000: ")
    assert view.text.object.endswith(" % undecided")


def test_the_button_stops_and_continues() -> None:
    view, calls = make_view()
    assert view.button.styles["visibility"] == "hidden"
    view.start()
    assert (view.button.label, view.button.styles["visibility"]) == (STOP, "visible")
    view.button.clicks += 1
    view.stop()
    assert (view.button.label, view.button.styles["visibility"]) == (CONTINUE, "visible")
    view.button.clicks += 1
    assert calls == ["cancel", "resume"]


def test_without_a_map_there_is_neither_text_nor_button() -> None:
    view, _ = make_view()
    view.start()
    view.fail()
    assert (view.text.object, view.button.styles["visibility"], view.bar.styles["opacity"]) == ("", "hidden", "0")
