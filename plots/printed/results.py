"""Draw results of the engine on Matplotlib axes, as HTML for notebooks, and as HoloViews elements."""

from __future__ import annotations

import base64
import html
import inspect
from collections.abc import Iterable
from functools import singledispatch
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import EscapeMap, LyapunovOrbit, Orbit, OrbitFamily, PeriodicOrbit, Potential, Result, Window
from engine.foundations.extras import require_package
from engine.maps.pixels import PixelAnalysis
from engine.results import (
    DecayLaws,
    EscapeStatistics,
    OrbitReturns,
    PeriodicOrbits,
    PotentialReview,
    Returns,
    SampledOrbits,
    Sweep,
    UncertaintyExponent,
)
from engine.slices.default_window import default_window
from engine.slices.planes import SPACE
from plots.layers.layer import Layer
from plots.layers.picture import ShownMap
from plots.layers.table import LAYERS, map_legend
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.orbit_curves import compute_orbit_curves, well_energy
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES
from plots.pictures.palette import DEFAULT_COLOURS, DEFAULT_PALETTE, LIGHT, MEASURED, Entry, Palette, find_palette, rgba
from plots.pictures.periodic_marks import STABILITY_COLOURS
from plots.printed.curve_figures import draw_chart
from plots.printed.figure_axes import RENDER_LOCK, legend_handles, set_font, set_title, style_axes
from plots.printed.map_figure import draw_picture
from plots.printed.orbit_figure import draw_path, draw_quantity
from plots.printed.potential_figure import draw_equipotentials, enlarge
from plots.printed.window_axes import draw_limits, draw_pixels, draw_strokes, show_window
from plots.studies.escape_charts import probabilities_chart, times_chart
from plots.studies.family import family_charts
from plots.studies.measure_charts import pairs_chart, survival_chart
from plots.studies.periodic import periodic_charts
from plots.studies.section import section_charts
from plots.studies.sweep_charts import sweep_charts

# Width and height of a picture, in inches.
_FIGURE_SIZE = (4.6, 4.0)
# Pixels per inch of a picture in a notebook.
_NOTEBOOK_DPI = 72.0
# Position of the legend of a map in shares of the axes: the middle, below the label of the horizontal axis.
_BELOW_AXES = (0.5, -0.13)
# CSS that puts the picture and the table of a result side by side.
_SIDE_BY_SIDE = "display:flex;gap:1em;flex-wrap:wrap;align-items:flex-start"
# Lowest position on a logarithmic axis, which cannot show 0. Smaller values are drawn at this position.
_LOG_FLOOR = 1e-16
# Largest number of points of a line with markers.
_MOST_MARKERS = 60
# Number of parameters of each `_draw…` function before its options: the result, the axes and the palette.
_FIXED_PARAMETERS = 3


class NoPictureError(TypeError):
    """The result has no picture."""


def plot_result(result: Result, ax: Axes | None = None, *, palette: str = DEFAULT_PALETTE, **options: Any) -> Axes:
    """Draw a result, as described in `engine.foundations.result.Result.plot`."""
    colours = find_palette(palette)
    legal_options = list(inspect.signature(_draw.dispatch(type(result))).parameters)[_FIXED_PARAMETERS:]
    if unknown := [name for name in options if name not in legal_options]:
        options_text = f"the picture of {type(result).__name__} has {', '.join(['palette', *legal_options])}"
        raise TypeError(f"{unknown[0]}: no such option; {options_text}")
    if ax is None:
        from matplotlib import pyplot

        _, ax = pyplot.subplots(figsize=_FIGURE_SIZE, layout="constrained")
    if not isinstance(ax, Axes):
        raise TypeError(f"ax={ax!r}: must be Matplotlib axes or None")
    _draw(result, ax, colours, **options)
    return ax


def to_html(result: Result) -> str:
    """Return the HTML for notebooks: a picture if there is one, a sentence about the result, and the numbers of the result."""
    describe = getattr(result, "describe", None)
    numbers = result.shown_numbers().items()
    rows = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in numbers)
    sentence = f"<p>{html.escape(describe())}</p>" if describe is not None else ""
    return (
        f"<div><strong>{type(result).__name__}</strong>{sentence}<div style='{_SIDE_BY_SIDE}'>"
        f"{_picture_html(result)}<table>{rows}</table></div></div>"
    )


def to_holoviews(result: Result) -> Any:
    """Return the HoloViews element, as described in `engine.foundations.result.Result.to_holoviews`."""
    require_package("holoviews", "page")
    import holoviews as hv

    from plots.pictures.holoviews_elements import axis_options, chart_elements

    if isinstance(result, EscapeMap | PixelAnalysis):
        return hv.Dataset(result.to_xarray()).to(hv.Image, list(result.spec.plane.axis_names))
    if charts := _find_charts(result, DEFAULT_COLOURS):
        overlays = [hv.Overlay(chart_elements(chart)) for chart in charts]
        # Options need an extension of HoloViews, which notebooks load.
        if hv.Store.loaded_backends():
            for overlay, chart in zip(overlays, charts, strict=True):
                for element in overlay:
                    element.opts(**axis_options(chart))
        return hv.Layout(overlays).cols(2)
    table = result.to_pandas()
    if result.row_dimension:
        table = table.rename_axis(result.row_dimension).reset_index()
    index, *value_names = table.columns
    return hv.Overlay([hv.Curve(table, index, name, label=name) for name in value_names if table[name].dtype.kind in "if"])


def _find_charts(result: Result, palette: Palette) -> list[Chart]:
    """Return the charts of a result; empty if it has other pictures."""
    match result:
        case Sweep():
            return sweep_charts(result, palette)
        case DecayLaws():
            return [survival_chart(result)]
        case EscapeStatistics():
            return [times_chart(result), probabilities_chart(result)]
        case UncertaintyExponent():
            return [pairs_chart(result)]
        case Returns() | OrbitReturns():
            return section_charts(result, palette)
        case PeriodicOrbits():
            return periodic_charts(result, palette)
        case OrbitFamily():
            return family_charts(result, palette)
    return []


def _picture_html(result: Result) -> str:
    file = BytesIO()
    figure = Figure(figsize=_FIGURE_SIZE, dpi=_NOTEBOOK_DPI, layout="constrained")
    with RENDER_LOCK:
        try:
            _draw(result, figure.subplots(), DEFAULT_COLOURS)
        except NoPictureError:
            return ""
        except ModuleNotFoundError as error:
            return f"<p>No picture: {html.escape(str(error))}</p>"
        set_font(figure)
        figure.savefig(file, format="png")
    return f"<img alt='{type(result).__name__}' src='data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}'>"


@singledispatch
def _draw(result: Result, axes: Axes, palette: Palette) -> None:
    """Draw the result of a layer, or a result that has charts or columns. Functions for other results are registered below."""
    for layer in LAYERS.values():
        if isinstance(result, layer.result):
            _draw_layer(layer, result, axes, palette)
            return
    if charts := _find_charts(result, palette):
        draw_chart(axes, charts[0])
        return
    _draw_columns(result, axes, palette)


def _draw_columns(result: Result, axes: Axes, palette: Palette) -> None:
    """Draw the columns of a result that its `chart` names, as a line or as bars."""
    chart = result.chart
    if chart is None:
        raise NoPictureError(f"{type(result).__name__} has no picture; its numbers are in to_pandas()")
    columns = result.columns()
    x = columns[chart.x]
    y = columns[chart.y]
    if chart.by_channel:
        axes.bar(list(map(str, x)), y, color=[palette.channels[channel - 1] for channel in x])
        style_axes(axes, labels=(chart.x_label, chart.y_label))
    else:
        drawn_y = np.maximum(y, _LOG_FLOOR) if "y" in chart.logarithmic else y
        shape = Shape.JOINED_POINTS if x.size <= _MOST_MARKERS else Shape.LINE
        frame = Frame("", "", (chart.x_label, chart.y_label), help="", logarithmic=chart.logarithmic)
        draw_chart(axes, Chart(frame, [Series("", MEASURED, x, drawn_y, shape)]))
    if chart.title:
        set_title(axes, chart.title.format(**result.numbers()))


def _draw_layer(layer: Layer[Any], result: Result, axes: Axes, palette: Palette) -> None:
    """Draw the result of a layer without the map."""
    spec = layer.spec_of(result)
    window = spec.find_window()
    panel = _add_panel(axes, window)
    if layer.pixels is not None:
        codes = layer.pixels.codes(result, None)
        pixels = rgba([*layer.pixels.colours(palette)])[codes]
        # `draw_pixels` takes row 0 on top.
        draw_pixels(panel, pixels[::-1], window, shown_window=window)
        if entries := layer.pixels.entries(result, palette):
            _add_legend_below(panel, entries)
    draw_limits(panel, spec.potential, spec.plane, spec.energy, window, palette.channels)
    if layer.over is not None and layer.over.strokes is not None:
        draw_strokes(panel, layer.over.strokes(result), window, palette)
    show_window(panel, window, *spec.plane.axis_symbols)
    set_title(panel, layer.title)


def _add_panel(axes: Axes, window: Window) -> Axes:
    """Give `axes` the coordinates of a window, and return new axes behind them, for drawings in shares of the window."""
    panel = axes.inset_axes((0.0, 0.0, 1.0, 1.0), zorder=-1.0)
    axes.set_xlim(window.x_low, window.x_high)
    axes.set_ylim(window.ordinate_low, window.ordinate_high)
    axes.patch.set_visible(False)
    axes.tick_params(bottom=False, left=False, labelbottom=False, labelleft=False)
    return panel


@_draw.register
def _draw_map(result: EscapeMap, axes: Axes, palette: Palette, *, picture: str = "basins") -> None:
    panel = _add_panel(axes, result.spec.find_window())
    draw_picture(panel, result, picture, palette)
    legend = map_legend(picture, ShownMap.of(result, palette, {}))
    if entries := [*legend.entries, *legend.others]:
        _add_legend_below(panel, entries)


def _add_legend_below(axes: Axes, entries: Iterable[Entry]) -> None:
    axes.legend(
        handles=legend_handles(entries), loc="upper center", bbox_to_anchor=_BELOW_AXES, ncols=3, fontsize="small", frameon=False
    )


@_draw.register
def _draw_orbit(result: Orbit, axes: Axes, palette: Palette, *, show: str = "path") -> None:
    if result.potential is None:
        raise NoPictureError("this orbit has no potential, so its exits are unknown")
    curves = compute_orbit_curves(result.potential, result, with_visits=show == "path")
    if show == "path":
        # The axes are square until `draw_path` has given the panel the aspect of the window.
        axes.set_box_aspect(1.0)
        panel = _add_panel(axes, curves.window)
        draw_path(panel, result.potential, [curves], palette)
        axes.set_box_aspect(panel.get_box_aspect())
        return
    quantity = next((each for each in ORBIT_QUANTITIES if each.name == show), None)
    if quantity is None:
        raise ValueError(f"show={show!r}: must be one of path, {', '.join(each.name for each in ORBIT_QUANTITIES)}")
    draw_quantity(axes, quantity, [curves], palette)


@_draw.register
def _draw_sampled_orbits(result: SampledOrbits, axes: Axes, palette: Palette) -> None:
    entries = []
    for fate in np.unique(result.fate).tolist():
        entries.append(palette.entry(fate, result.outcomes))
        # A NaN after each path separates the paths.
        has_fate = result.fate == fate
        x, y = (np.pad(paths[has_fate], ((0, 0), (0, 1)), constant_values=np.nan) for paths in (result.x, result.y))
        axes.plot(x.ravel(), y.ravel(), color=entries[-1].colour, linewidth=0.8)
    axes.set_aspect("equal")
    style_axes(axes, labels=("x", "y"), title="Paths")
    _add_legend_below(axes, entries)


@_draw.register
def _draw_periodic_orbit(result: PeriodicOrbit, axes: Axes, palette: Palette) -> None:
    axes.plot(*result.find_path()[1:3], color=STABILITY_COLOURS[result.stability], linewidth=1.6)
    axes.set_aspect("equal", adjustable="datalim")
    style_axes(axes, labels=("x", "y"), title=f"{result.stability.value.capitalize()}, T = {result.period:.6g}")


@_draw.register
def _draw_lyapunov(result: LyapunovOrbit, axes: Axes, palette: Palette) -> None:
    axes.plot(*result.half_path.T, color=palette.channels[result.channel - 1], linewidth=2.2)
    axes.set_aspect("equal", adjustable="datalim")
    style_axes(axes, labels=("x", "y"), title=f"Lyapunov orbit {result.channel} at h = {result.energy:.6g}")


@_draw.register
def _draw_potential(result: Potential, axes: Axes, palette: Palette) -> None:
    if not result.escapes_over_saddles:
        raise NoPictureError(f"the potential {result.name} has an escape radius and therefore no well to draw")
    window = enlarge(default_window(result, SPACE, well_energy(result)))
    draw_equipotentials(axes, result, window)
    for channel, (x, y) in enumerate(result.saddles.tolist(), 1):
        axes.plot(x, y, "o", color=palette.channels[channel - 1], markeredgecolor=LIGHT.halo, zorder=3)
    axes.set_xlim(window.x_low, window.x_high)
    axes.set_ylim(window.ordinate_low, window.ordinate_high)
    axes.set_aspect("equal")
    style_axes(axes, labels=("x", "y"), title=f"{result.name}: {_escape_text(result)}")


def _escape_text(potential: Potential) -> str:
    return f"escape energy {potential.escape_energy:.6g}" if potential.channels else "no exits"


@_draw.register
def _draw_review(result: PotentialReview, axes: Axes, palette: Palette) -> None:
    if result.refusal is not None:
        raise NoPictureError("a potential that cannot be used has no picture")
    _draw_potential(result.potential, axes, palette)


@_draw.register
def _draw_sweep(result: Sweep, axes: Axes, palette: Palette, *, measure: str | None = None) -> None:
    charts = {chart.frame.name: chart for chart in sweep_charts(result, palette)}
    if not charts:
        raise NoPictureError("a sweep without numbers against the energy or a parameter has no picture")
    if measure is not None and measure not in charts:
        raise ValueError(f"measure={measure!r}: must be one of {', '.join(charts)}")
    # By default, the first measure.
    draw_chart(axes, charts[measure or next(iter(charts))])
