"""Figures keep their callbacks, and models are added with one search of the page's models."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import panel as pn
from bokeh.document import Document
from bokeh.document.models import DocumentModelManager
from bokeh.events import Tap
from bokeh.models import ColumnDataSource, Scatter

from app.views.components.plots import (
    HOVER_FORMATS,
    FigurePane,
    LaterGlyphs,
    PictureTexts,
    chart_hover,
    square_figure,
    with_gaps,
)


def test_a_figure_shown_again_handles_each_event_once() -> None:
    heard: list[float] = []
    pane = FigurePane(square_figure("r2", "R²", "Help."), {Tap: lambda event: heard.append(event.x)})
    column, document = pn.Column(pane), Document()
    column.server_doc(document)
    for x in (1.0, 2.0):
        document.callbacks.trigger_event(Tap(pane.object, x=x))
        column.objects = []
        column.objects = [pane]
    assert heard == [1.0, 2.0]


def test_glyphs_are_added_with_one_search_of_the_models() -> None:
    plots, document = [square_figure(name, name, "Help.") for name in ("basins", "times")], Document()
    glyphs = LaterGlyphs(lambda: [(ColumnDataSource(), Scatter())])
    for plot in plots:
        document.add_root(plot)
        glyphs.add_figure(plot)
    with patch.object(DocumentModelManager, "recompute", autospec=True) as recompute:
        glyphs.draw()
        assert recompute.call_count == 1
    glyphs.draw()
    assert all(len(plot.renderers) == 1 for plot in plots)


def test_a_figure_that_is_made_later_gets_the_glyphs_that_other_figures_have() -> None:
    glyphs = LaterGlyphs(lambda: [(ColumnDataSource(), Scatter())], level="annotation")
    glyphs.draw()
    plots = [square_figure(name, name, "Help.") for name in ("basins", "times")]
    for plot in plots:
        glyphs.add_figure(plot)
    [renderer] = plots[0].renderers
    assert renderer.level == "annotation"
    assert plots[1].renderers == [renderer]


def test_lines_are_joined_with_a_gap_between_them() -> None:
    first, second = np.array([[0.0, 1.0], [2.0, 3.0]]), np.array([[4.0, 5.0]])
    joined = with_gaps([first, second])
    gap = np.full((1, 2), np.nan)
    np.testing.assert_array_equal(joined, np.concatenate([gap, first, gap, second, gap]))
    np.testing.assert_array_equal(with_gaps([]), gap)


def test_another_title_is_written_into_the_same_model() -> None:
    plot = square_figure("basins", "Basins", "Help.")
    [title] = plot.elements
    texts = PictureTexts("Basins of another map", "Other", ("x", "px"), "channels 1 to 3")
    texts.write_above(plot, room=60)
    assert plot.elements == [title]
    assert "<h2>Basins of another map <" in title.html
    texts.write_above(plot, room=10)
    assert "<h2>Other <" in title.html


def test_every_value_of_a_chart_is_written_in_its_format() -> None:
    hover = chart_hover("@share{percent} from @low{number}@note", [])
    assert "@share{custom} from @low{custom}@note" in hover.tooltips
    assert {value: formatter.code for value, formatter in hover.formatters.items()} == {
        "@share": HOVER_FORMATS["percent"],
        "@low": HOVER_FORMATS["number"],
    }
