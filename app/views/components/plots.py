"""Bokeh figures of one style. They fill their place on the page. A figure's frame is the area inside its axes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Event
from bokeh.model import Model
from bokeh.models import (
    BasicTickFormatter,
    ColumnDataSource,
    CustomJSHover,
    CustomJSTickFormatter,
    Glyph,
    GlyphRenderer,
    HoverTool,
    NoOverlap,
    Range1d,
    Span,
)
from bokeh.models.dom import HTML
from bokeh.plotting import figure

from app.browser.module_files import NUMBERS_MODULE
from app.state.help_texts import HELP_TEXTS, title_with_help
from engine import Window
from plots.browser.javascript import callback_code
from plots.pictures.axis_labels import find_offset
from plots.pictures.histories import logarithmic_limits

_OFFSET_LABEL_CODE = callback_code(Path(__file__).with_name("offset_ticks.js"), "offsetLabel(tick, base, unit)")

HOVER_FORMATS = {name: callback_code(NUMBERS_MODULE, f"{name}(value)") for name in ("number", "count", "percent")}
"""JavaScript that formats a `value`: as a number of four digits, a whole number in groups of digits, or a percentage."""

# A value in a hover text, with the name of its format.
_HOVER_VALUE = re.compile(r"([@$]\w+)\{(\w+)\}")

# Name of a momentum, px or py.
_MOMENTUM = re.compile(r"^p([xy])$")

# The point between two lines.
_GAP = np.full((1, 2), np.nan)

# Width of a history over its height.
_HISTORY_ASPECT = 2.2
# Borders of histories, in pixels.
_HISTORY_BORDERS = {"min_border_left": 48, "min_border_right": 10, "min_border_top": 28, "min_border_bottom": 25}

CHART_BORDERS = {"min_border_left": 58, "min_border_right": 10, "min_border_top": 28, "min_border_bottom": 40}
"""Borders of charts, in pixels. Left plus right is top plus bottom, so a square figure has a square frame."""

# Borders of pictures, in pixels. The title is above the frame, and the legend is below the labels of the axis.
_PICTURE_BORDERS = {"min_border_left": 48, "min_border_right": 10, "min_border_top": 22, "min_border_bottom": 36}

# Power of ten of the last decimal of a label. Longer labels would not fit into the left border, and would narrow the frame.
_FINEST_LABEL = -2

# A compact picture has a title, but no axes. A small picture has nothing around its frame.
_COMPACT_BORDERS = {"min_border_left": 12, "min_border_right": 12, "min_border_top": 22, "min_border_bottom": 2}
_SMALL_BORDERS = dict.fromkeys(_PICTURE_BORDERS, 2)
_BORDERS = {"compact": _COMPACT_BORDERS, "small": _SMALL_BORDERS}

# Desired number of labels of an axis, and that of pictures below the large ones.
_MOST_TICKS = 5
_TICKS = {"half": 3, "third": 3}


def map_figure(name: str, title: str, x: Range1d, y: Range1d) -> figure:
    """Return the square figure of a picture, see `square_figure`. `PictureTexts` stand around its frame."""
    # A frame aligned with the frames of larger pictures would not be square.
    plot = square_figure(name, title, HELP_TEXTS[name], x_range=x, y_range=y, frame_align=False, **_PICTURE_BORDERS)
    labels_apart = NoOverlap()
    for axis in (*plot.below, *plot.left):
        axis.update(major_label_text_font_size="14px", major_label_policy=labels_apart)
        axis.ticker.desired_num_ticks = _MOST_TICKS
    return plot


def history_figure(name: str, title: str, **options: Any) -> figure:
    """Return a low figure with the time of orbits as abscissa, see `square_figure`. Its title names the values."""
    plot = square_figure(name, title, HELP_TEXTS[name], aspect_ratio=_HISTORY_ASPECT, **_HISTORY_BORDERS, **options)
    plot.elements[0].html += "<i class='axis-name abscissa'>t →</i>"
    return plot


def set_borders(plot: figure, kind: str) -> None:
    """Set the borders of a picture, and show its axes unless the kind is "compact" or "small"."""
    for axis in (*plot.below, *plot.left):
        axis.visible = kind not in _BORDERS
        axis.ticker.desired_num_ticks = _TICKS.get(kind, _MOST_TICKS)
    plot.update(**_BORDERS.get(kind, _PICTURE_BORDERS))


@dataclass(frozen=True)
class PictureTexts:
    """What stands around the frame of a picture.

    Attributes
    ----------
    title, short_title
        The title above the frame, and that of a picture that is too small for it.
    axes
        Names of the abscissa and the ordinate.
    legend
        HTML below the frame, see `legends.picture_legend`.
    offsets
        What the labels of the axes mean, see `label_axes`.
    note
        HTML about all pictures, which only the picked picture has.
    under_way
        What is being computed.
    """

    title: str
    short_title: str
    axes: tuple[str, str]
    legend: str
    offsets: Sequence[str] = ()
    note: str = ""
    under_way: str = ""

    def write_above(self, plot: figure, *, room: int, button: str = "") -> None:
        """Write above the frame: the title, the name of the ordinate, what is being computed, and the HTML of a button.

        The title is short if `room`, the number of characters that fit into the line, is too small.
        """
        enlarge = f"Enlarge, or show all: {self.title}"
        is_short = len(self.title) + len(self.under_way) > room
        title, under_way = (self.short_title, "…" if self.under_way else "") if is_short else (self.title, self.under_way)
        html = (
            f"{title_with_help(title, plot.name, HELP_TEXTS[plot.name], under_way)}{button}"
            f"<button type='button' class='enlarge' data-picture='{plot.name}' aria-label='{enlarge}' title='{enlarge}'></button>"
            f"<i class='axis-name ordinate'>{_axis_name(self.axes[1])} ↑</i>"
        )
        # The model is reused, because Bokeh would search all models of the page for a new model.
        plot.elements[0].html = html

    def below(self, *, is_picked: bool) -> str:
        """Return the HTML below the frame."""
        meanings = "".join(f"<small>{offset}</small>" for offset in self.offsets)
        return f"<i class='axis-name'>{_axis_name(self.axes[0])} →</i>{self.legend}{meanings}{self.note if is_picked else ''}"


def _axis_name(name: str) -> str:
    """Return the name of an axis with the subscript of a momentum, as HTML."""
    return _MOMENTUM.sub(r"p<sub>\1</sub>", name)


def label_axes(plots: Iterable[figure], names: tuple[str, str], window: Window) -> list[str]:
    """Label the axes of the pictures of a window; return what labels that are distances mean, such as x = 0.5 + … × 10⁻⁶."""
    offsets = [find_offset(low, high, _FINEST_LABEL) for low, high in window.ranges]
    for plot in plots:
        for axis, offset in zip((plot.below[0], plot.left[0]), offsets, strict=True):
            if offset is not None:
                numbers = {"base": float(offset.base), "unit": 10.0**offset.exponent}
                axis.formatter = CustomJSTickFormatter(args=numbers, code=_OFFSET_LABEL_CODE)
            elif isinstance(axis.formatter, CustomJSTickFormatter):
                axis.formatter = BasicTickFormatter()
    return [offset.explain(name) for name, offset in zip(names, offsets, strict=True) if offset is not None]


def square_figure(name: str, title: str, text: str, **options: Any) -> figure:
    """Return a figure with a title and a help text, without tools. By default, it is square.

    Parameters
    ----------
    name
        Name of the model.
    title
        Displayed title.
    text
        Help text of the figure.
    **options
        Options of `bokeh.plotting.figure`.
    """
    defaults = {"tools": "", "toolbar_location": None, "aspect_ratio": 1, **CHART_BORDERS}
    plot = figure(title=None, **(defaults | options))
    style_chart(plot, name, title, text)
    return plot


def style_chart(plot: figure, name: str, title: str, text: str) -> None:
    """Give a figure the style of all charts, its name, and its title with a help text; see `square_figure`."""
    plot.update(name=name, sizing_mode="scale_width", center=[], background_fill_alpha=0.0, border_fill_alpha=0.0)
    # `plot.axis` would search all models of the figure for each attribute.
    for axis in (*plot.below, *plot.left):
        axis.update(axis_label_text_font_size="12px", major_label_text_font_size="12px", axis_label_text_font_style="normal")
        axis.update(major_tick_line_color=None, major_tick_out=2, minor_tick_line_color=None, minor_tick_out=0)
    plot.css_classes = [name]
    plot.html_attributes = {"role": "group", "aria-label": title}
    plot.elements = [HTML(html=title_with_help(title, name, text))]


class FigurePane(pn.pane.Bokeh):
    """A figure with callbacks for events. Panel removes them with the figure, so they are set at each return of the figure.

    Parameters
    ----------
    plot
        The figure.
    events
        Callback of each event.
    """

    def __init__(self, plot: figure, events: Mapping[type[Event], Callable[[Any], None]] = MappingProxyType({})) -> None:
        super().__init__(plot, margin=0)
        self._events = events

    def _get_model(self, *arguments: Any, **options: Any) -> Model:
        for event, callback in self._events.items():
            self.object.on_event(event, callback)
        return super()._get_model(*arguments, **options)


def changing_models(plots: Sequence[figure]) -> AbstractContextManager[object]:
    """Return a context in which models of figures are replaced. Bokeh searches the page for models once, at the end.

    Without figures, nothing is searched.
    """
    document = plots[0].document if plots else None
    return document.models.freeze() if document is not None else nullcontext()


SourcedGlyphs = Sequence[tuple[ColumnDataSource, Glyph]]
"""Glyphs with their data sources, from back to front."""


class LaterGlyphs:
    """Glyphs that are made and added to figures when they are first shown. All figures share their renderers.

    Parameters
    ----------
    make
        Returns the glyphs.
    level
        Level of the glyphs in a figure, a name in `bokeh.core.enums.RenderLevel`.
    """

    def __init__(self, make: Callable[[], SourcedGlyphs], level: str = "glyph") -> None:
        self._make, self._level = make, level
        self._renderers: list[GlyphRenderer] = []
        self._waiting_plots: list[figure] = []

    def add_figure(self, plot: figure) -> None:
        """Add the glyphs to a figure, at once if other figures have them, otherwise when `draw` is called."""
        if self._renderers:
            self._add(plot)
        else:
            self._waiting_plots.append(plot)

    def draw(self) -> None:
        """Add the glyphs to the figures that lack them, and to later figures."""
        self._renderers = self._renderers or [
            GlyphRenderer(data_source=source, glyph=glyph, level=self._level) for source, glyph in self._make()
        ]
        plots, self._waiting_plots = self._waiting_plots, []
        with changing_models(plots):
            for plot in plots:
                self._add(plot)

    def _add(self, plot: figure) -> None:
        plot.renderers = [*plot.renderers, *self._renderers]


def with_gaps(lines: Sequence[np.ndarray]) -> np.ndarray:
    """Return lines, arrays of points (n, 2), as one line of shape (m, 2) with a gap, a point of NaN, before and after each.

    Lines of the same style are sent to the browser as one line. Bokeh sends each array in two messages of its own. The stable
    manifolds of a case have a thousand lines, and their messages would occupy the event loop for seconds.
    """
    return np.concatenate([_GAP, *(part for line in lines for part in (line, _GAP))])


def set_range(axis_range: Range1d, low: float, high: float) -> None:
    """Set the ends of an axis, and the ends to which the reset tool returns."""
    axis_range.update(start=low, end=high, reset_start=low, reset_end=high)


def set_decades(axis_range: Range1d, low: float, high: float) -> None:
    """Set the ends of a logarithmic axis: the power of ten below `low`, and a number a little above `high`."""
    set_range(axis_range, *logarithmic_limits(low, high))


def moving_line(dimension: str, **options: Any) -> Span:
    """Return a line across figures in the colour of the text. The figures are not painted again when the line moves."""
    return Span(dimension=dimension, level="overlay", styles={"--bk-line-color": "var(--ui-ink)"}, **options)


def hover_html(text: str) -> str:
    """Return the HTML of a hover text in the type of the page, whose stylesheet does not reach into a tooltip."""
    weighted = text.replace("<b>", '<b style="font-weight:600">')
    return f'<div style="font-size:12px;line-height:16px;color:var(--ui-ink)">{weighted}</div>'


def chart_hover(text: str, renderers: Sequence[GlyphRenderer], **options: Any) -> HoverTool:
    """Return a tool that describes the points of a chart under the mouse.

    Parameters
    ----------
    text
        HTML with values written ``@column{format}`` or ``$variable{format}``, where the format is a name in `HOVER_FORMATS`.
    renderers
        The renderers whose points are described.
    **options
        Options of `bokeh.models.HoverTool`.
    """
    formatters = {value: CustomJSHover(code=HOVER_FORMATS[name]) for value, name in _HOVER_VALUE.findall(text)}
    tooltips = hover_html(_HOVER_VALUE.sub(r"\1{custom}", text))
    return HoverTool(tooltips=tooltips, formatters=formatters, renderers=list(renderers), visible=False, **options)
