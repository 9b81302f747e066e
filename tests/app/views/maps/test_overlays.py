"""Overlays have the colours of their channels and marks."""

from __future__ import annotations

import numpy as np
import pytest
from bokeh.models import ColumnDataSource, Image

from app.state.view_state import ViewState
from app.views.components.plots import map_figure
from app.views.maps.overlays import Overlays
from engine import CASES, find_stable_manifolds
from engine.results import StableManifolds
from plots.layers.table import LAYERS, PICTURES
from plots.pictures.palette import PALETTES
from tests.app.map_actions import make_browser_engine


@pytest.fixture(scope="module")
def manifolds() -> StableManifolds:
    return find_stable_manifolds(CASES["II"], 0.3, images=1)


def test_curves_have_the_colours_of_their_channels_while_they_are_drawn(manifolds: StableManifolds) -> None:
    state = ViewState()
    overlays = Overlays(ColumnDataSource(), state)
    overlays.show("manifolds", manifolds)
    for name, palette in PALETTES.items():
        state.palette = name
        assert set(overlays.curves["manifolds"].data["colour"]) == set(palette.channels[:3])
    overlays.remove("manifolds")
    assert overlays.curves["manifolds"].data["xs"] == []


def test_the_lines_of_an_exit_are_one_line_with_gaps(manifolds: StableManifolds) -> None:
    overlays = Overlays(ColumnDataSource(), ViewState())
    overlays.show("manifolds", manifolds)
    columns = overlays.curves["manifolds"].data
    assert len(columns["xs"]) == 3 < len(manifolds.arcs)
    for name, positions in (("xs", [arc.x for arc in manifolds.arcs]), ("ys", [arc.ordinate for arc in manifolds.arcs])):
        sent = np.concatenate(columns[name])
        np.testing.assert_array_equal(np.sort(sent[~np.isnan(sent)]), np.sort(np.concatenate(positions)))


def test_marks_are_added_once_to_the_pictures_over_which_they_lie() -> None:
    store = make_browser_engine()
    plots = {name: map_figure(name, name, store.x, store.ordinate) for name in PICTURES if name != "curves"}
    overlays = Overlays(ColumnDataSource(), ViewState())
    for name, plot in plots.items():
        overlays.draw(plot, name)
    for _ in range(2):
        overlays.show("trust", None)
    marked = [name for name, plot in plots.items() for one in plot.renderers if isinstance(one.glyph, Image)]
    over = LAYERS["trust"].over
    assert over is not None
    assert marked == [name for name in over.pictures if name in plots]
