"""The status shows the shares of outcomes in their colours, and the progress of a map."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from app.state.view_state import ViewState
from app.views.maps.progress import CONTINUE, STOP, STOPPED, ProgressView
from engine import CASES, EscapeMap, Fate, MapSpec, Plane, compute_map, parse_formula
from plots.layers.table import LAYERS
from plots.pictures.palette import PALETTES


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e3))


def make_view(state: ViewState | None = None) -> tuple[ProgressView, list[str]]:
    calls: list[str] = []
    return ProgressView(state or ViewState(), *(partial(calls.append, name) for name in ("cancel", "resume"))), calls


def test_a_complete_map_gives_its_shares(escape_map: EscapeMap) -> None:
    view, _ = make_view()
    view.show(escape_map)
    text = re.sub(r"<[^>]*>", "", view.text.object)
    assert re.match(r"exit 1&nbsp;\d+\.\d %exit 2&nbsp;\d+\.\d %bounded&nbsp;\d+\.\d %✓ t = 1 000 details", text)
    assert (view.bar.styles["opacity"], view.button.styles["visibility"]) == ("0", "hidden")
    assert "unresolved" not in text
    view.show(replace(escape_map, fate=np.where(escape_map.fate == 1, Fate.FAILED, escape_map.fate)))
    assert "unresolved" in view.text.object


def test_exits_that_are_closed_at_the_energy_have_no_share() -> None:
    # One saddle lies at h = 0.1667, and two lie at 0.1109.
    well = parse_formula("0.5(x^2+y^2) + 1.2 x^2 y - y^3/3")
    shown = {}
    for energy in (0.05, 0.12, 0.2):
        view, _ = make_view()
        view.show(compute_map(MapSpec(well, Plane.X_PX, energy, (15, 15), t_max=100.0)))
        shown[energy] = re.sub(r"<[^>]*>", "", view.text.object)
    assert "closed: exit 1, exit 2, exit 3" in shown[0.05]
    assert re.match(r"exit 2&nbsp;[\d.]+ %exit 3&nbsp;[\d.]+ %bounded&nbsp;[\d.]+ %closed: exit 1", shown[0.12])
    assert re.match(r"exit 1&nbsp;[\d.]+ %exit 2&nbsp;[\d.]+ %exit 3&nbsp;[\d.]+ %bounded", shown[0.2])


def test_a_map_in_progress_gives_time_and_undecided_share(escape_map: EscapeMap) -> None:
    view, _ = make_view()
    view.show(replace(escape_map, horizon=100.0, complete=False))
    assert "100.0 % decided, t = 100 of 1 000" in view.text.object


def test_the_button_stops_and_continues() -> None:
    view, calls = make_view()
    assert view.button.styles["visibility"] == "hidden"
    view.start()
    assert (view.button.label, view.button.styles["visibility"]) == (STOP, "visible")
    view.button.clicks += 1
    view.stop()
    assert (view.button.label, view.button.styles["visibility"]) == (CONTINUE, "visible")
    assert STOPPED in view.text.css_classes
    view.button.clicks += 1
    assert calls == ["cancel", "resume"]
    view.start()
    assert STOPPED not in view.text.css_classes
    view.fail()
    assert (re.sub(r"<[^>]*>", "", view.text.object), view.button.styles["visibility"], view.bar.styles["opacity"]) == (
        "",
        "hidden",
        "0",
    )


def test_a_deep_zoom_says_how_many_pixels_are_lost_to_rounding_and_offers_the_test(escape_map: EscapeMap) -> None:
    state = ViewState()
    view, _ = make_view(state)
    view.show(replace(escape_map, rounded_share=0.273))
    assert "about 27 % of the pixels depend on rounding errors" in re.sub(r"<[^>]*>", "", view.text.object)
    assert (view.button.label, view.button.styles["visibility"]) == (LAYERS["trust"].title, "visible")
    # The text is long, so the button is not over the text.
    assert "stop" not in view.button.css_classes
    view.button.clicks += 1
    assert state.layers == {"trust"}
    for share in (None, 0.004, float("nan")):
        view.show(replace(escape_map, rounded_share=share))
        assert "rounding" not in view.text.object
        assert view.button.styles["visibility"] == "hidden"


def test_the_bar_has_a_part_for_each_outcome_in_its_colour(escape_map: EscapeMap) -> None:
    state = ViewState()
    view, _ = make_view(state)
    view.show(escape_map)
    shares = escape_map.fractions()
    for name, palette in PALETTES.items():
        state.palette = name
        parts = re.findall(r"flex-grow:([\d.]+);background:(#\w+)", view.text.object)
        colours = [*palette.channels[:2], palette.bounded]
        assert parts == [(f"{shares[fate]:.4f}", colour) for fate, colour in zip((1, 2, Fate.BOUNDED), colours, strict=True)]
