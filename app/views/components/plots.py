"""Bokeh figures with the same size and look; their text and axis colours come from the stylesheet."""

from __future__ import annotations

import math
from typing import Any

import panel as pn
from bokeh.models import BoxSelectTool, BoxZoomTool, CrosshairTool, PanTool, Range1d, ResetTool, Span, WheelZoomTool
from bokeh.plotting import figure

from app.state.help_texts import help_details

FRAME = 300
"""Side of each picture in pixels: four fit a screen of 1600, one fits a phone of 420."""

COLUMN = FRAME + 75
"""Width of a picture with its axes."""

TEXT = FRAME + 60
"""Width of the text below a picture."""


def map_figure(name: str, title: str, ranges: tuple[Range1d, Range1d], spans: tuple[Span, Span]) -> figure:
    """A picture of a plane; pictures with the same ranges and spans share zoom and crosshair."""
    wheel = WheelZoomTool()
    # The box selects pixels to count; without renderers the image keeps its look.
    box = BoxSelectTool(renderers=[], description="Count in a box")
    zoom = BoxZoomTool(match_aspect=True, description="Zoom into a box")
    tools = [PanTool(), wheel, zoom, box, ResetTool(), CrosshairTool(overlay=spans, visible=False)]
    return square_figure(name, title, tools=tools, active_scroll=wheel, x_range=ranges[0], y_range=ranges[1], x_axis_label="x")


def square_figure(name: str, title: str, **options: Any) -> figure:
    """A square figure without a grid, with a toolbar that is shown while the mouse is over it."""
    plot = figure(name=name, title=title, toolbar_location="above", frame_width=FRAME, frame_height=FRAME, **options)
    plot.toolbar.autohide = True
    plot.toolbar.logo = None
    plot.center = []
    plot.title.text_font_size = "14px"
    plot.axis.axis_label_text_font_size, plot.axis.major_label_text_font_size = "12px", "11px"
    plot.axis.axis_label_text_font_style = "normal"
    plot.axis.major_tick_line_color = plot.axis.minor_tick_line_color = None
    plot.background_fill_alpha = plot.border_fill_alpha = 0.0
    return plot


def with_help(picture: pn.viewable.Viewable, name: str, *below: pn.viewable.Viewable) -> pn.Column:
    """A picture, what belongs below it, and its help text."""
    help_text = pn.pane.HTML(help_details(name), width=TEXT, margin=(0, 5))
    return pn.Column(picture, *below, help_text, margin=(0, 6), width=COLUMN)


def set_range(edges: Range1d, low: float, high: float) -> None:
    """Set the ends of an axis, also for the reset tool."""
    edges.update(start=low, end=high, reset_start=low, reset_end=high)


def set_decades(edges: Range1d, low: float, high: float) -> None:
    """Set a logarithmic axis to start at the power of ten below `low` and to end a little above `high`."""
    set_range(edges, 10.0 ** math.floor(math.log10(low)), 1.3 * high)
