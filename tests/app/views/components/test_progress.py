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
    assert (view.bar.styles["opacity"], view.button.disabled) == ("0", True)


def test_a_map_in_progress_gives_time_and_undecided_share(escape_map: EscapeMap) -> None:
    view, _ = make_view()
    view.show(replace(escape_map, horizon=100.0, complete=False))
    assert view.text.object.startswith("Full resolution, t = 100 of 1 000: ")
    assert view.text.object.endswith(" % undecided")


def test_the_button_stops_and_continues() -> None:
    view, calls = make_view()
    view.start()
    assert view.button.label == STOP
    view.button.clicks += 1
    view.stop()
    assert (view.button.label, view.button.disabled) == (CONTINUE, False)
    view.button.clicks += 1
    assert calls == ["cancel", "resume"]


def test_a_message_is_shown_as_text() -> None:
    view, _ = make_view()
    view.warn("<b>x</b>")
    assert "&lt;b&gt;x&lt;/b&gt;" in view.problem.object
    assert view.problem.visible
