"""Every value of a text has a format."""

from __future__ import annotations

import re

import pytest
from bokeh.models import HoverTool

from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.analysis.curves import CurvesView
from app.views.analysis.statistics import StatisticsView
from plots.pictures.sweep_panels import CURVE_PANELS


@pytest.fixture(scope="module")
def chart_hovers() -> list[HoverTool]:
    """The hover tools of all charts."""
    statistics = StatisticsView(lambda: None, lambda text: None)
    measures = BasinMeasuresView(lambda: None, lambda text: None, lambda: None)
    curves = CurvesView(lambda: None, lambda energy: None)
    plots = [*(pane.object for pane in statistics.build()[1:]), measures._draw_survival(), measures._draw_uncertainty()]
    plots += [curves._draw_shares(), *map(curves._draw_panel, CURVE_PANELS)]
    return [tool for plot in plots for tool in plot.tools if isinstance(tool, HoverTool)]


def test_every_chart_has_a_hover(chart_hovers: list[HoverTool]) -> None:
    # Two charts of statistics, two of measures, the shares, and all curves of the other panels.
    assert len(chart_hovers) == 14


@pytest.mark.parametrize("place", range(14))
def test_every_value_of_a_text_has_a_format(chart_hovers: list[HoverTool], place: int) -> None:
    hover = chart_hovers[place]
    assert isinstance(hover.tooltips, str)
    values = set(re.findall(r"([@$]\w+){custom}", hover.tooltips))
    assert values
    assert values <= set(hover.formatters)
    assert hover.renderers
