"""The histories of several orbits share one time axis."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from bokeh.document import Document
from bokeh.document.models import DocumentModelManager
from bokeh.models import ColumnDataSource
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.orbits.orbit_plots import OrbitPlots
from engine import CASES, integrate_orbit
from plots.pictures.orbit_curves import OrbitCurves, compute_orbit_curves, restrict_curves

NAMES = ("sali", "exponent", "r2")


def curves_of(state: tuple[float, ...], t_max: float) -> OrbitCurves:
    return compute_orbit_curves(CASES["I"], integrate_orbit(CASES["I"], state, t_max))


@pytest.fixture(scope="module")
def drawings() -> list[OrbitCurves]:
    """Return the curves of an orbit that is bounded until t = 2e4, and of an orbit that escapes at t = 15."""
    return [curves_of((-0.46, 0.0, 0.0, 0.2), 2e4), curves_of((0.1, 0.0, 0.05, 0.6), 2e4)]


@pytest.fixture
def plots() -> OrbitPlots:
    return OrbitPlots(ViewState(), lambda interval: None)


def figures(plots: OrbitPlots) -> dict[str, figure]:
    return {pane.object.name: pane.object for part in plots.parts() for pane in part()}


def data(plot: figure, name: str) -> dict[str, Any]:
    (source,) = [one.data_source for one in plot.renderers if one.data_source.name == name]
    assert isinstance(source, ColumnDataSource)
    return dict(source.data)


def test_all_histories_have_one_logarithmic_time_axis(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    drawn = figures(plots)
    plots.show(drawings, chosen=1)
    assert [type(drawn[name].xaxis[0]).__name__ for name in NAMES] == ["LogAxis"] * 3
    assert len({id(drawn[name].x_range) for name in NAMES}) == 1
    assert drawn["r2"].x_range.end == drawings[0].orbit.t[-1]


def test_short_orbits_have_r2_against_linear_time(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    def scales() -> list[str]:
        return [type(drawn[name].x_scale).__name__ for name in NAMES]

    drawn, (long, short) = figures(plots), drawings
    plots.show([short], chosen=0)
    assert scales() == ["LogScale", "LogScale", "LinearScale"]
    plots.show([short, long], chosen=0)
    assert scales() == ["LogScale"] * 3


def test_the_page_is_searched_only_when_axes_of_time_change_and_then_once(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    document, (long, short) = Document(), drawings
    for plot in figures(plots).values():
        document.add_root(plot)
    plots.show([short], chosen=0)
    with patch.object(DocumentModelManager, "recompute", autospec=True) as recompute:
        plots.show([short, long], chosen=0)
        # The axis of R² has another scale, ticker and formatter.
        assert recompute.call_count == 1
        plots.show([long], chosen=0)
    assert recompute.call_count == 1


def test_a_long_orbit_that_is_not_chosen_keeps_its_curve(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    drawn = figures(plots)
    plots.show(drawings, chosen=1)
    lines, bands = data(drawn["r2"], "r2_histories"), data(drawn["r2"], "r2_bands")
    assert (lines["slot"], bands["slot"][:2]) == ([0, 1], [0, 1])
    times, values = lines["xs"][0], lines["ys"][0]
    early = times < 15.0
    expected = drawings[0].orbit.r2[np.searchsorted(drawings[0].orbit.t.astype(np.float32), times[early])]
    np.testing.assert_allclose(values[early], expected, rtol=1e-6)
    assert bands["xs"][0].max() == times[-1] == np.float32(drawings[0].orbit.t[-1])
    assert np.isnan(bands["xs"][1]).all()
    assert bands["alpha"][0] < lines["alpha"][0] < lines["alpha"][1] == 1.0


def test_an_interval_is_that_of_all_histories(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    drawn = figures(plots)
    plots.show([restrict_curves(one, 5.0, 12.0) for one in drawings], 0, (5.0, 12.0))
    assert (drawn["r2"].x_range.start, drawn["sali"].x_range.end) == (5.0, 12.0)


def test_an_interval_after_the_end_of_an_orbit_shows_the_others(plots: OrbitPlots, drawings: list[OrbitCurves]) -> None:
    drawn = figures(plots)
    plots.show([restrict_curves(one, 100.0, 200.0) for one in drawings], 1, (100.0, 200.0))
    assert (drawn["r2"].x_range.start, drawn["r2"].x_range.end) == (100.0, 200.0)
    assert data(drawn["r2"], "r2_histories")["xs"][1].size == 0
