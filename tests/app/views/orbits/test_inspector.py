"""The inspector of the orbits is made in parts."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import panel as pn

from app.browser.components.orbit_components import OrbitPlayer
from app.state.view_state import ViewState
from app.views.orbits.inspector import Inspector
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES


def do_nothing(*_: object) -> None:
    pass


def test_the_texts_and_each_figure_have_a_turn_of_the_event_loop_of_their_own() -> None:
    turns: list[Callable[[], None]] = []
    state, actions = ViewState(), OrbitActions(*[do_nothing] * 5)
    inspector = Inspector(
        OrbitControls(state, actions),
        OrbitPlayer(do_nothing),
        OrbitPlots(state, do_nothing),
        SeparationPlot(state),
        lambda call: lambda: turns.append(call),
    )

    def count() -> tuple[int, int]:
        parts = inspector.layout()
        return len(list(parts.select(OrbitPlayer))), len(list(parts.select(pn.pane.Bokeh)))

    inspector.follow(1, 1)
    counts = [count()]
    while turns:
        turns.pop(0)()
        counts.append(count())
    assert counts[0] == (0, 0)
    assert counts[-1] == (1, len(ORBIT_QUANTITIES) + 1)
    assert all(sum(after) - sum(before) <= 1 for before, after in pairwise(counts))
