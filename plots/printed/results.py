"""Draw results of the engine on Matplotlib axes, as HTML for notebooks, and as HoloViews elements."""

from __future__ import annotations

import base64
import html
import inspect
from collections.abc import Mapping
from io import BytesIO
from typing import Any
from weakref import WeakKeyDictionary

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.legend import Legend

from engine import EscapeMap, Result
from engine.foundations.extras import require_package
from engine.foundations.validation import checked_flag, short_repr
from engine.maps.pixels import PixelAnalysis
from engine.results import Drawing, Sweep
from plots.pictures.charts import Limits
from plots.pictures.palette import DEFAULT_COLOURS, DEFAULT_PALETTE, find_palette
from plots.printed.figure_axes import RENDER_LOCK, add_legend_below, figure_of, legend_handles, set_font, size_in_points
from plots.printed.result_views import NoPictureError, View, charts_of, view_of
from plots.printed.window_axes import labelled

# Width and height of a picture, in inches.
_FIGURE_SIZE = (4.6, 4.0)
# Pixels per inch of a picture in a notebook.
_NOTEBOOK_DPI = 72.0
# Distance of a legend below the axes, in units of the font size of the axis label.
_BELOW_AXES = 3.6
# CSS that puts the picture and the table of a result side by side.
_SIDE_BY_SIDE = "display:flex;gap:1em;flex-wrap:wrap;align-items:flex-start"
# Options of pictures of all results, for error messages.
_COMMON_OPTIONS = ("palette", "legend", "colorbar")
# Name in Matplotlib of the projection of axes in which results are drawn, which are not polar or three-dimensional.
_PROJECTION = "rectilinear"
# Number of parameters of each function of `view_of` before its options: the result and the palette.
_FIXED_PARAMETERS = 2
# Labels of the axes in which each artist was drawn.
_LABELS: WeakKeyDictionary[Artist, tuple[str, str]] = WeakKeyDictionary()
# Limits that the results in axes gave to each axis, "x" or "y". If the caller sets others, those are kept.
_FITTED: WeakKeyDictionary[Axes, dict[str, Limits]] = WeakKeyDictionary()


def plot_result(
    result: Result,
    ax: Axes | None = None,
    *,
    palette: str | Mapping[int, Any] = DEFAULT_PALETTE,
    legend: bool | None = None,
    colorbar: bool | None = None,
    **options: Any,
) -> Drawing:
    """Draw a result, as described in `engine.foundations.result.Result.plot`."""
    legal_options = list(inspect.signature(view_of.dispatch(type(result))).parameters)[_FIXED_PARAMETERS:]
    if unknown := [name for name in options if name not in legal_options]:
        options_text = f"the picture of {type(result).__name__} has {', '.join([*_COMMON_OPTIONS, *legal_options])}"
        raise TypeError(f"{unknown[0]}: no such option; {options_text}")
    if ax is not None and getattr(ax, "name", None) != _PROJECTION:
        raise TypeError(f"ax={short_repr(ax)}: must be Matplotlib axes or None, and not polar or three-dimensional")
    for name, flag in {"legend": legend, "colorbar": colorbar}.items():
        if flag is not None:
            checked_flag(name, flag)
    view = view_of(result, find_palette(palette, _outcomes_of(result)), **options)
    if colorbar and not view.has_scale:
        raise TypeError("colorbar=True: must be False or None for a picture without a colour scale")
    if ax is not None:
        return _draw(view, ax, legend=bool(legend), colorbar=bool(colorbar))
    from matplotlib import pyplot

    _, axes = pyplot.subplots(figsize=_FIGURE_SIZE, layout="constrained")
    return _draw_alone(view, axes, legend=legend is not False, colorbar=colorbar is not False)


def _outcomes_of(result: Result) -> Any:
    """Return the outcomes to whose numbers the fates of a result refer; empty if they are exits only."""
    request = getattr(result, "spec", result)
    return getattr(getattr(request, "potential", request), "outcomes", ())


def _draw_alone(view: View, axes: Axes, *, legend: bool = True, colorbar: bool = True) -> Drawing:
    """Draw a view with its title in axes of its own."""
    axes.set_title(view.title, loc="left")
    return _draw(view, axes, legend=legend, colorbar=colorbar and view.has_scale)


def _draw(view: View, axes: Axes, *, legend: bool, colorbar: bool) -> Drawing:
    """Draw a view in axes that may already show other results, and that keep the labels, limits and aspect that they have."""
    earlier = [labels for artist in axes.get_children() if (labels := _LABELS.get(artist)) is not None]
    if earlier and earlier[0] != view.labels:
        (x, y), (own_x, own_y) = earlier[0], view.labels
        raise ValueError(f"ax: shows {y} against {x}; must be other axes for {own_y} against {own_x}")
    _prepare(view, axes, is_first=not earlier)
    limits = _free_limits(view, axes, is_first=not earlier)
    artists = view.draw(axes)
    # Matplotlib fits free limits to each artist, so they are set last. Those of a plane stay.
    for axis, axis_limits in limits.items():
        getattr(axes, f"set_{axis}lim")(axis_limits, auto=not view.is_plane)
        _FITTED.setdefault(axes, {})[axis] = getattr(axes, f"get_{axis}lim")()
    _LABELS.update(dict.fromkeys(artists, view.labels))
    images = [artist for artist in artists if isinstance(artist, AxesImage | QuadMesh)]
    image = images[-1] if images else None
    bar = None
    if colorbar and image is not None:
        bar = figure_of(axes).colorbar(image, ax=axes, label=view.title)
    return Drawing(axes, tuple(artists), image, _add_legend(view, axes, artists) if legend else None, bar)


def _prepare(view: View, axes: Axes, *, is_first: bool) -> None:
    """Set labels, scales and aspect where nobody has set them."""
    axes.set(xlabel=axes.get_xlabel() or view.labels[0], ylabel=axes.get_ylabel() or view.labels[1])
    if is_first:
        axes.set(**{f"{axis}scale": "log" for axis in view.logarithmic})
    if is_first and view.is_equal and axes.get_aspect() == "auto" and axes.get_box_aspect() is None:
        axes.set_aspect("equal", adjustable="box" if view.limits else "datalim")


def _free_limits(view: View, axes: Axes, *, is_first: bool) -> dict[str, Limits]:
    """Return the limits of the axes that nobody has set.

    They contain those of earlier charts in these axes, and of the first results in axes that share them.
    """
    limits = {}
    for axis, (low, high) in zip("xy", view.limits or (), strict=False):
        earlier = getattr(axes, f"get_{axis}lim")()
        is_free = getattr(axes, f"get_autoscale{axis}_on")()
        is_joined = _is_fitted(axes, axis, earlier) if is_first else is_free and not view.is_plane
        if is_joined:
            limits[axis] = min(low, earlier[0]), max(high, earlier[1])
        elif is_free:
            limits[axis] = low, high
    return limits


def _is_fitted(axes: Axes, axis: str, limits: Limits) -> bool:
    """Return whether the limits of an axis are those of results in axes that share it."""
    shared = getattr(axes, f"get_shared_{axis}_axes")().get_siblings(axes)
    return any(_FITTED.get(other, {}).get(axis) == limits for other in shared)


def _add_legend(view: View, axes: Axes, artists: list[Artist]) -> Legend | None:
    """Add a legend with the entries of the results that the axes show; None without entries."""
    earlier = axes.get_legend()
    handles = [*(earlier.legend_handles if earlier is not None else ()), *legend_handles(view.entries), *labelled(artists)]
    # A remark after a colon, as in "outside: starts beyond an exit", would make a narrow legend long.
    entries = {str(handle.get_label()).partition(":")[0]: handle for handle in handles if handle is not None}
    if not entries:
        return None
    style: dict[str, Any] = {"frameon": False, "fontsize": "small", "handlelength": 1.4, "columnspacing": 1.3}
    if not view.is_plane:
        return axes.legend([*entries.values()], [*entries], **style)
    depth = _BELOW_AXES * float(axes.xaxis.label.get_fontsize())
    return add_legend_below(axes, entries, (0.0, depth), size_in_points(axes)[0], style)


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
    if charts := charts_of(result, DEFAULT_COLOURS):
        overlays = [hv.Overlay(chart_elements(chart)) for chart in charts]
        # Options need an extension of HoloViews, which notebooks load.
        if hv.Store.loaded_backends():
            for overlay, chart in zip(overlays, charts, strict=True):
                for element in overlay:
                    element.opts(**axis_options(chart))
        return hv.Layout(overlays).cols(2)
    table = result.to_pandas()
    if isinstance(result, Sweep):
        return hv.HeatMap(table, list(result.axes))
    if result.row_dimension:
        table = table.rename_axis(result.row_dimension).reset_index()
    index, *value_names = table.columns
    return hv.Overlay([hv.Curve(table, index, name, label=name) for name in value_names if table[name].dtype.kind in "if"])


def _picture_html(result: Result) -> str:
    file = BytesIO()
    figure = Figure(figsize=_FIGURE_SIZE, dpi=_NOTEBOOK_DPI, layout="constrained")
    with RENDER_LOCK:
        try:
            _draw_alone(view_of(result, DEFAULT_COLOURS), figure.subplots())
        except NoPictureError:
            return ""
        except ModuleNotFoundError as error:
            return f"<p>No picture: {html.escape(str(error))}</p>"
        set_font(figure)
        figure.savefig(file, format="png")
    return f"<img alt='{type(result).__name__}' src='data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}'>"
