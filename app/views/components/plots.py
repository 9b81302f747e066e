"""Bokeh figures that look alike: square, quiet, with the tools that every picture has."""

from __future__ import annotations

import math
from typing import Any

import panel as pn
from bokeh.models import BoxSelectTool, BoxZoomTool, CrosshairTool, PanTool, Range1d, ResetTool, Span, WheelZoomTool
from bokeh.plotting import figure

from app.rendering.palette import DARK, LIGHT
from app.state.help_texts import help_details

FRAME = 300
"""Side of each picture in pixels: four fit a screen of 1600, one fits a phone of 420."""

_LETTERS = "Roboto, Helvetica, Arial, sans-serif"

PANE = FRAME + 75
"""Width of a picture with its axes."""


def map_figure(name: str, title: str, ranges: tuple[Range1d, Range1d], spans: tuple[Span, Span]) -> figure:
    """A picture of a plane; pictures with the same ranges and spans move together and have one crosshair."""
    wheel = WheelZoomTool()
    # A box that chooses pixels to count leaves the image as it is.
    box = BoxSelectTool(renderers=[], description="Box to count")
    zoom = BoxZoomTool(match_aspect=True, description="Box to zoom into")
    tools = [PanTool(), wheel, zoom, box, ResetTool(), CrosshairTool(overlay=spans, visible=False)]
    return square_figure(name, title, tools=tools, active_scroll=wheel, x_range=ranges[0], y_range=ranges[1], x_axis_label="x")


def square_figure(name: str, title: str, **options: Any) -> figure:
    """A square figure without a grid, whose tools appear when the mouse does."""
    plot = figure(name=name, title=title, toolbar_location="above", frame_width=FRAME, frame_height=FRAME, **options)
    plot.toolbar.autohide = True
    plot.toolbar.logo = None
    plot.center = []
    plot.title.text_font_size = "14px"
    plot.axis.axis_label_text_font_style = "normal"
    plot.axis.major_tick_line_color = plot.axis.minor_tick_line_color = None
    # The page's theme gives the same to all figures that it knows from the start, and their colours.
    plot.background_fill_alpha = plot.border_fill_alpha = 0.0
    return plot


def with_help(picture: pn.viewable.Viewable, name: str, *below: pn.viewable.Viewable) -> pn.Column:
    """A picture over what belongs to it and its explanation."""
    helping = pn.pane.HTML(help_details(name), width=FRAME + 60, margin=(0, 5))
    return pn.Column(picture, *below, helping, margin=(0, 6), width=PANE)


def set_range(edges: Range1d, low: float, high: float) -> None:
    """Show this part of an axis, and come back to it on reset."""
    edges.update(start=low, end=high, reset_start=low, reset_end=high)


def set_decades(edges: Range1d, low: float, high: float) -> None:
    """Show whole decades of a logarithmic axis from below `low`, and a little more than `high`: marks stand at powers of ten."""
    set_range(edges, 10.0 ** math.floor(math.log10(low)), 1.3 * high)


def dress(plot: figure, *, dark: bool) -> None:
    """The letters and colours of a light page or a dark one, for a figure that comes later than the page."""
    inks = DARK if dark else LIGHT
    plot.axis.axis_label_text_font = plot.axis.major_label_text_font = _LETTERS
    plot.axis.axis_label_text_font_size, plot.axis.major_label_text_font_size = "12px", "11px"
    plot.title.text_color = plot.axis.axis_label_text_color = inks.text
    plot.axis.major_label_text_color = plot.axis.axis_line_color = inks.quiet
