"""Charts have the same axes on the page, in figures and in HoloViews."""

from __future__ import annotations

from dataclasses import replace

import holoviews as hv
import numpy as np
import pytest
from matplotlib.figure import Figure

from app.views.components.charts import ChartView
from engine import CASES, MapSpec, Plane, SweepSpec, compute_map, compute_statistics, compute_sweep, fit_decay_laws
from plots.pictures.charts import Chart, Frame, Limits, Series, Shape, Tile
from plots.pictures.holoviews_elements import axis_options
from plots.pictures.palette import PAPER
from plots.printed.curve_figures import draw_chart
from plots.studies.escape_charts import probabilities_chart, times_chart
from plots.studies.measure_charts import survival_chart
from plots.studies.sweep_charts import sweep_charts

FRAME = Frame("points", "Points", ("x", "y"), help="Three points.")
POINTS = Series("points", "#123456", np.array([5.0, 6.0, np.nan]), np.array([10.0, 20.0, 30.0]), Shape.POINTS)
BARS = (np.array([9.0, 18.0, 28.0]), np.array([11.0, 22.0, 32.0]))
EDGES = (np.array([0.5, 1.5]), np.array([1.5, 2.5]))
TILE = Tile(np.array([[0, 1], [1, 0]], np.uint8), 0.5, 0.25, "h = 0.2", "a map")
CHARTS = {
    "fitted": Chart(FRAME, [POINTS]),
    "fitted to error bars": Chart(FRAME, [replace(POINTS, bars=BARS)]),
    "fitted along y": Chart(FRAME, [POINTS], ((0.0, 10.0), None)),
    "fitted on logarithmic axes": Chart(replace(FRAME, logarithmic="xy"), [POINTS]),
    "of one point": Chart(FRAME, [replace(POINTS, x=np.array([0.2]), y=np.array([0.0]))]),
    "of bars": Chart(FRAME, [Series("", "#123456", np.array([1.0, 2.0]), np.array([3.0, 4.0]), Shape.BARS, EDGES)]),
    "of rings": Chart(FRAME, [replace(POINTS, shape=Shape.RINGS, notes=("one", "two", "three"))]),
    "of crosses": Chart(FRAME, [replace(POINTS, shape=Shape.CROSSES)]),
    "of a thick line": Chart(FRAME, [replace(POINTS, shape=Shape.THICK)]),
    "with tiles": Chart(replace(FRAME, has_tiles=True), [], ((0.0, 2.0), (0.0, 1.5)), [TILE], ["#123456", "#abcdef"]),
    "without points": Chart(FRAME, [replace(POINTS, x=np.zeros(0), y=np.zeros(0))]),
    "without points, logarithmic": Chart(replace(FRAME, logarithmic="xy"), []),
}


def on_the_page(chart: Chart) -> tuple[Limits, Limits]:
    view = ChartView(chart.frame)
    view.show(chart)
    return (view.x_range.start, view.x_range.end), (view.y_range.start, view.y_range.end)


def in_a_figure(chart: Chart) -> tuple[Limits, Limits]:
    axes = Figure().subplots()
    draw_chart(axes, chart)
    return axes.get_xlim(), axes.get_ylim()


def in_holoviews(chart: Chart) -> tuple[Limits, Limits]:
    hv.renderer("bokeh")
    options = axis_options(chart)
    return options["xlim"], options["ylim"]


def charts_of_results() -> list[Chart]:
    """Return charts of the measures of a map and of a sweep with one energy."""
    escape_map = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.24, (24, 24), t_max=100.0))
    statistics = compute_statistics(escape_map)
    sweep = compute_sweep(SweepSpec(CASES["II"], Plane.X_PX, (0.24,), (12, 12), t_max=50.0))
    laws = survival_chart(fit_decay_laws(escape_map))
    return [times_chart(statistics), probabilities_chart(statistics), laws, *sweep_charts(sweep, PAPER)]


def assert_equal_axes(chart: Chart) -> None:
    for drawn in (on_the_page(chart), in_a_figure(chart), in_holoviews(chart)):
        np.testing.assert_allclose(drawn, chart.axis_limits, rtol=1e-12)


@pytest.mark.parametrize("name", CHARTS)
def test_axes_are_equal_in_all_renderers(name: str) -> None:
    assert_equal_axes(CHARTS[name])


def test_axes_of_measures_are_equal_in_all_renderers() -> None:
    for chart in charts_of_results():
        assert_equal_axes(chart)


def test_tiles_have_the_same_places_and_colours_on_the_page_and_in_figures() -> None:
    chart = CHARTS["with tiles"]
    view = ChartView(chart.frame)
    view.show(chart)
    data = view.tiles.data
    assert [data[name][0] for name in ("x", "y", "side", "top", "text")] == [0.5, 0.25, 1.0, 1.25, "a map"]
    axes = Figure().subplots()
    draw_chart(axes, chart)
    (image,) = axes.images
    assert image.get_extent() == [0.5, 1.5, 0.25, 1.25]
    np.testing.assert_array_equal(image.get_array()[0, 1], [0xAB, 0xCD, 0xEF, 0xFF])
    np.testing.assert_array_equal(data["image"][0], TILE.codes)


@pytest.mark.parametrize("name", [name for name in CHARTS if name.startswith(("fitted", "of"))])
def test_fitted_axes_contain_all_points_and_their_bars(name: str) -> None:
    chart = CHARTS[name]
    for axis, (low, high) in zip("xy", chart.axis_limits, strict=True):
        for values in chart.series[0].extent(axis):
            assert low < np.nanmin(values) <= np.nanmax(values) < high or "logarithmic" in name


def test_an_axis_is_fitted_with_a_small_margin() -> None:
    x, y = CHARTS["fitted"].axis_limits
    assert x == pytest.approx((4.95, 6.05))
    assert y == pytest.approx((9.0, 31.0))
