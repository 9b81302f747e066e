"""Figures keep their callbacks, and several models are added with one search of the page's models."""

from __future__ import annotations

from unittest.mock import patch

import panel as pn
from bokeh.document import Document
from bokeh.document.models import DocumentModelManager
from bokeh.events import Tap
from bokeh.models import Scatter

from app.views.components.plots import FigurePane, annotate_picture, batched_additions, square_figure


def test_a_figure_that_comes_back_to_the_page_hears_each_event_once() -> None:
    heard: list[float] = []
    pane = FigurePane(square_figure("r2", "R²"), {Tap: lambda event: heard.append(event.x)})
    column, document = pn.Column(pane), Document()
    column.server_doc(document)
    for x in (1.0, 2.0):
        document.callbacks.trigger_event(Tap(pane.object, x=x))
        column.objects = []
        column.objects = [pane]
    assert heard == [1.0, 2.0]


def test_glyphs_are_added_with_one_search_of_the_models() -> None:
    plots, document = [square_figure(name, name) for name in ("basins", "times")], Document()
    for plot in plots:
        document.add_root(plot)
    with patch.object(DocumentModelManager, "recompute", autospec=True) as recompute:
        with batched_additions(plots):
            for plot in plots:
                plot.add_glyph(Scatter())
        assert recompute.call_count == 1
    assert all(len(plot.renderers) == 1 for plot in plots)


def test_another_legend_needs_no_search_of_the_models() -> None:
    plot, document = square_figure("basins", "Basins"), Document()
    document.add_root(plot)
    with patch.object(DocumentModelManager, "recompute", autospec=True) as recompute:
        annotate_picture(plot, "Basins", ("x", "y"), "channels 1 to 4")
        annotate_picture(plot, "Basins", ("x", "y"), "channels 1 to 3")
    assert "channels 1 to 3" in plot.elements[0].html
    assert not recompute.called
