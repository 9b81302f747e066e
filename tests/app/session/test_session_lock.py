"""Bokeh models are changed under the session's lock, or while changes are held.

Panel applies changes of widgets without the lock when a click follows within Panel's debounce time. If such a change leads to a
change of a bare model that is not held, Bokeh raises an error, and the click is lost.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import panel as pn
import pytest

from app.session.explorer import Explorer
from app.state.view import Analysis
from app.views.maps.map_toolbar import Drag
from app.views.panels.controls import LOCK_SCALE
from engine import Plane, compute_map
from plots.layers.table import LAYERS
from plots.pictures.image_columns import map_columns
from tests.app.browser_messages import send
from tests.app.other_loop import run_on_new_loop
from tests.app.session.opened_page import opened_page, run_callbacks


def update(**values: Any) -> Callable[[Explorer], None]:
    """Return a function that changes the view state as lists and tabs do."""

    def change(explorer: Explorer) -> None:
        with pn.io.hold():
            explorer.state.param.update(**values)

    return change


CLOSER = {"xLow": -0.1, "xHigh": 0.1, "ordinateLow": -0.1, "ordinateHigh": 0.1}

CHANGES: list[Callable[[Explorer], Any]] = [
    # This moves the markers of the orbit plots.
    lambda explorer: send(explorer.orbits.player, {"step": 10, "begin": 0, "end": 10}),
    lambda explorer: send(explorer.engine, {"name": "energy", "value": 0.3, "count": 1, "done": True}),
    lambda explorer: send(explorer.engine, {"name": "window", "value": CLOSER, "count": 1, "done": False}),
    lambda explorer: explorer.controls.case.param.update(value="II"),
    lambda explorer: explorer.controls.plane.param.update(value=Plane.X_Y),
    update(t_max=1e3),
    update(resolution=112),
    update(palette="safe"),
    *(
        lambda explorer, name=name, on=on: explorer.controls.layers.switches[name].param.update(value=on)
        for name, layer in LAYERS.items()
        for on in ([layer.title], [])
    ),
    *(update(analysis=analysis) for analysis in Analysis),
    *(lambda explorer, drag=drag: explorer.maps.toolbar.drag.param.update(value=drag) for drag in (Drag.ZOOM, Drag.COUNT)),
    *(lambda explorer, name=name: explorer.drawers.buttons.param.update(value=[name]) for name in ("gallery", "share", "help")),
]


def show_orbits(explorer: Explorer) -> None:
    """Show the panel and the player of orbits."""
    explorer.orbits.inspector.follow(2, 2)
    explorer.orbits.player.follow((0.0, 10.0))


def show_map(explorer: Explorer) -> None:
    """Show a map, whose legends say whether the colour scale is locked."""
    frame = compute_map(replace(explorer.state.map_spec(), resolution=(8, 8), t_max=10.0))
    explorer.maps.map_arrived(frame, map_columns(frame))


def lock_and_unlock_colours(explorer: Explorer) -> None:
    """Open the section "Quality and colours", and turn its switch on and off."""
    parts = pn.Column(*explorer.controls.layout())
    [fold] = parts.select(lambda part: getattr(part, "label", "") == "▸ Quality and colours")
    fold.clicks += 1
    [lock] = parts.select(lambda part: getattr(part, "options", []) == [LOCK_SCALE])
    for value in ([LOCK_SCALE], []):
        lock.param.update(value=value)


def with_page(change: Callable[[Explorer], Any], prepare: Callable[[Explorer], None] = show_orbits) -> None:
    """Call a function with the explorer of a page, without the session's lock."""

    async def run() -> None:
        async with opened_page(prepare=prepare) as (explorer, session):
            await run_callbacks(session)
            change(explorer)
            await run_callbacks(session)

    run_on_new_loop(run)


def test_widget_changes_need_no_lock(caplog: pytest.LogCaptureFixture) -> None:
    with_page(lambda explorer: [change(explorer) for change in CHANGES])
    assert [record for record in caplog.records if record.exc_info] == []


def test_the_switch_of_the_colour_scale_needs_no_lock(caplog: pytest.LogCaptureFixture) -> None:
    with_page(lock_and_unlock_colours, prepare=show_map)
    assert [record for record in caplog.records if record.exc_info] == []


def test_bare_models_need_the_lock() -> None:
    with pytest.raises(RuntimeError, match="document lock"):
        with_page(lambda explorer: explorer.orbits.plots.set_time(1.0))
