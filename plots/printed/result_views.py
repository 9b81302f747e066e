"""How results are drawn in axes: an entry for each kind of result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial, singledispatch
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, Normalize
from matplotlib.scale import get_scale_names

from engine import MEASURES, EscapeMap, LyapunovOrbit, Orbit, OrbitFamily, PeriodicOrbit, Potential, Result, Window
from engine.foundations.validation import checked_choice, checked_count, short_repr
from engine.results import (
    DecayLaws,
    EscapeStatistics,
    OrbitReturns,
    PeriodicOrbits,
    PotentialReview,
    Returns,
    SampledOrbits,
    Sweep,
    Threshold,
    UncertaintyExponent,
)
from engine.slices.default_window import default_window
from engine.slices.planes import SPACE
from plots.layers.table import LAYERS
from plots.pictures.charts import Chart, Frame, Limits, Series, Shape
from plots.pictures.orbit_curves import compute_orbit_curves, well_energy
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES
from plots.pictures.palette import LIGHT, MEASURED, Entry, Palette
from plots.pictures.periodic_marks import STABILITY_COLOURS
from plots.printed.curve_figures import draw_series
from plots.printed.orbit_figure import draw_histories, draw_paths_and_exits, quantity_axes
from plots.printed.plane_picture import PlanePicture, layer_picture, map_picture
from plots.printed.potential_figure import draw_equipotentials, enlarge
from plots.studies.escape_charts import probabilities_chart, times_chart
from plots.studies.family import family_charts
from plots.studies.measure_charts import pairs_chart, survival_chart
from plots.studies.periodic import periodic_charts
from plots.studies.section import section_charts
from plots.studies.sweep_charts import CURVE_PANELS, SHARES, sweep_charts

# Lowest position on a logarithmic axis, which cannot show 0. Smaller values are drawn at this position.
_LOG_FLOOR = 1e-16
# Largest number of points of a line with markers.
_MOST_MARKERS = 60
# Names of a colour map and of a scale, for error messages.
_SCALE_EXAMPLES = {"cmap": "viridis", "norm": "log"}
# Why a sweep is not drawn.
_NO_CURVES = "a sweep without values, or whose measures have no curves, has no picture"
# Labels of the axes of paths.
_PATH_LABELS = "x", "y"


class NoPictureError(TypeError):
    """The result has no picture."""


@dataclass(frozen=True, eq=False)
class View:
    """How a result is drawn in axes.

    Attributes
    ----------
    labels
        Labels of the x axis and the y axis.
    draw
        Draws the result and returns its artists, from back to front. Curves that belong into a legend have a label.
    limits
        Limits of the axes; None for those that fit the artists.
    title
        Title of the picture.
    entries
        Entries of the legend before those of the artists.
    is_plane
        Whether the axes are coordinates of a plane, in which further results are drawn over this one. Then its limits stay, and
        the legend is below the axes. Otherwise further results extend the limits, and the legend is in a corner.
    is_equal
        Whether both axes have the same scale.
    logarithmic
        Letters of the logarithmic axes, such as "xy".
    has_scale
        Whether the last image has a colour scale.
    """

    labels: tuple[str, str]
    draw: Callable[[Axes], list[Artist]]
    limits: tuple[Limits, Limits] | None = None
    title: str = ""
    entries: Sequence[Entry] = ()
    is_plane: bool = False
    is_equal: bool = False
    logarithmic: str = ""
    has_scale: bool = False


@singledispatch
def view_of(result: Result, palette: Palette, *, cmap: Any = None, norm: Any = None) -> View:
    """Return the view of a result. Functions for kinds of results that are no layers and have options are registered below.

    Raises
    ------
    NoPictureError
        If the result has no picture.
    """
    for layer in LAYERS.values():
        if isinstance(result, layer.result):
            return _plane_view(layer_picture(layer, result, palette), cmap, norm)
    _check_scale(cmap, norm, has_scale=False)
    charts = charts_of(result, palette)
    return _chart_view(charts[0]) if charts else _column_view(result, palette)


def charts_of(result: Result, palette: Palette) -> list[Chart]:
    """Return the charts of a result; empty if it has other pictures."""
    match result:
        case Sweep() if len(result.axes) == 1:
            return sweep_charts(result, palette)
        case Threshold():
            return [_threshold_chart(result)]
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


def _threshold_chart(result: Threshold) -> Chart:
    """Return the chart of the measures of all maps, and the value that is reached."""
    level = result.wanted, f"{result.quantity} = {result.wanted:.6g}"
    frame = Frame("threshold", result.quantity, (result.axis, result.quantity), help="", level=level)
    bars = result.measured_low, result.measured_high
    return Chart(frame, [Series("maps", MEASURED, result.value, result.measured, Shape.POINTS, bars)])


def _chart_view(chart: Chart) -> View:
    frame = chart.frame
    draw = partial(draw_series, chart=chart)
    return View(frame.labels, draw, chart.axis_limits, frame.title, is_plane=frame.is_square, logarithmic=frame.logarithmic)


def _column_view(result: Result, palette: Palette) -> View:
    """Return the view of the columns that `Result.chart` names, as a line or as bars."""
    chart = result.chart
    if chart is None:
        raise NoPictureError(f"{type(result).__name__} has no picture; its numbers are in to_pandas()")
    columns, labels = result.columns(), (chart.x_label, chart.y_label)
    x, y, title = columns[chart.x], columns[chart.y], chart.title.format(**result.numbers())
    if chart.by_channel:
        colours = [palette.channels[channel - 1] for channel in x]
        return View(labels, lambda axes: [*axes.bar(list(map(str, x)), y, color=colours)], title=title)
    drawn_y = np.maximum(y, _LOG_FLOOR) if "y" in chart.logarithmic else y
    shape = Shape.JOINED_POINTS if x.size <= _MOST_MARKERS else Shape.LINE
    frame = Frame("", title, labels, help="", logarithmic=chart.logarithmic)
    return _chart_view(Chart(frame, [Series("", MEASURED, x, drawn_y, shape)]))


def _plane_view(picture: PlanePicture, cmap: Any, norm: Any) -> View:
    _check_scale(cmap, norm, has_scale=picture.values is not None)
    plane, legend = picture.spec.plane, picture.legend
    return View(
        plane.axis_symbols,
        partial(picture.draw, cmap=cmap, norm=norm),
        picture.spec.find_window().ranges,
        picture.title,
        [*legend.entries, *legend.others, *legend.over],
        is_plane=True,
        has_scale=picture.values is not None,
    )


def _plate_view(result: Sweep, measure: str | None, outcome: int | None, cmap: Any, norm: Any) -> View:
    """Return the view of a measure of a sweep with two axes, as an image; of the shares, that of one outcome."""
    drawn = {one.name: next(iter(one.labels)) for one in CURVE_PANELS if set(one.labels) <= set(result.dataset)}
    if "share" in result.dataset:
        drawn = {SHARES.name: "share", **drawn}
    if not (drawn and result.values.size):
        raise NoPictureError(_NO_CURVES)
    _check_scale(cmap, norm, has_scale=True)
    name = next(iter(drawn)) if measure is None else checked_choice("measure", measure, drawn)
    values, title = result[drawn[name]], MEASURES[name].title
    if name == SHARES.name:
        labels = ["bounded", *(each.label for each in result.outcomes)]
        shown = checked_count("outcome", 0 if outcome is None else outcome, 0, len(labels) - 1)
        values, title = values[..., shown], f"Share: {labels[shown]}"
    else:
        _check_no_outcome(outcome)

    def draw(axes: Axes) -> list[Artist]:
        return [axes.pcolormesh(*map(result.__getitem__, result.axes), values.T, shading="nearest", cmap=cmap, norm=norm)]

    x_symbol, y_symbol = result.symbols
    return View((x_symbol, y_symbol), draw, title=title, is_plane=True, has_scale=True)


def _check_scale(cmap: Any, norm: Any, *, has_scale: bool) -> None:
    """Raise TypeError for a scale that a picture does not have, and ValueError for one that Matplotlib does not know."""
    for name, value, kind, names in (("cmap", cmap, Colormap, colormaps), ("norm", norm, Normalize, get_scale_names())):
        if value is None:
            continue
        if not has_scale:
            raise TypeError(f"{name}={value!r}: must be None for a picture without a colour scale")
        if not isinstance(value, kind) and not (isinstance(value, str) and value in names):
            legal = f"a {kind.__name__} of Matplotlib or the name of one, such as {_SCALE_EXAMPLES[name]!r}"
            raise ValueError(f"{name}={short_repr(value)}: must be {legal}")


def _check_no_outcome(outcome: int | None) -> None:
    if outcome is not None:
        raise TypeError(f"outcome={outcome!r}: must be None for a picture that is not of the share of one outcome")


@view_of.register
def _map_view(result: EscapeMap, palette: Palette, *, picture: str = "basins", cmap: Any = None, norm: Any = None) -> View:
    return _plane_view(map_picture(result, picture, palette), cmap, norm)


@view_of.register
def _orbit_view(result: Orbit, palette: Palette, *, show: str = "path") -> View:
    if result.potential is None:
        raise NoPictureError("this orbit has no potential, so its exits are unknown")
    checked_choice("show", show, ("path", "crossings", *(each.name for each in ORBIT_QUANTITIES)))
    if show == "crossings":
        points = result.find_section_crossings().T
        return View(
            result.section.axes.symbols,
            lambda axes: [*axes.plot(*points, "o", color=palette.orbits[0], markersize=2.0, markeredgewidth=0.0)],
            is_plane=True,
        )
    curves = compute_orbit_curves(result.potential, result, with_visits=show == "path")
    if show == "path":
        draw = partial(draw_paths_and_exits, potential=result.potential, orbits=[curves], palette=palette)
        return View(_PATH_LABELS, draw, curves.window.ranges, "Path", is_plane=True, is_equal=True)
    quantity = next(each for each in ORBIT_QUANTITIES if each.name == show)
    logarithmic, limits = quantity_axes(quantity, [curves])
    draw = partial(draw_histories, quantity=quantity, orbits=[curves], palette=palette)
    return View(("t", quantity.label), draw, limits, quantity.title, logarithmic=logarithmic)


@view_of.register
def _sampled_view(result: SampledOrbits, palette: Palette) -> View:
    def draw(axes: Axes) -> list[Artist]:
        lines: list[Artist] = []
        for fate in np.unique(result.fate).tolist():
            entry = palette.entry(fate, result.outcomes)
            # A NaN after each path separates the paths.
            has_fate = result.fate == fate
            x, y = (np.pad(paths[has_fate], ((0, 0), (0, 1)), constant_values=np.nan) for paths in (result.x, result.y))
            lines += axes.plot(x.ravel(), y.ravel(), color=entry.colour, linewidth=0.8, label=entry.label)
        return lines

    return View(_PATH_LABELS, draw, title="Paths", is_plane=True, is_equal=True)


def _closed_path_view(points: tuple[np.ndarray, np.ndarray], colour: str, width: float, label: str, title: str) -> View:
    def draw(axes: Axes) -> list[Artist]:
        return [*axes.plot(*points, color=colour, linewidth=width, label=label)]

    return View(_PATH_LABELS, draw, title=title, is_plane=True, is_equal=True)


@view_of.register
def _periodic_view(result: PeriodicOrbit, palette: Palette) -> View:
    words = result.stability.value
    _, x, y, *_ = result.find_path()
    title = f"{words.capitalize()}, T = {result.period:.6g}"
    return _closed_path_view((x, y), STABILITY_COLOURS[result.stability], 1.6, f"periodic, {words}", title)


@view_of.register
def _lyapunov_view(result: LyapunovOrbit, palette: Palette) -> View:
    x, y = result.half_path.T
    label = f"Lyapunov orbit {result.name}"
    return _closed_path_view((x, y), palette.channels[result.channel - 1], 2.2, label, f"{label} at h = {result.energy:.6g}")


@view_of.register
def _potential_view(result: Potential, palette: Palette) -> View:
    if not result.escapes_over_saddles:
        raise NoPictureError(f"the potential {result.name} has an escape radius and therefore no well to draw")
    window = enlarge(default_window(result, SPACE, well_energy(result)))
    escape = f"escape energy {result.escape_energy:.6g}" if result.channels else "no exits"
    draw = partial(_draw_potential, potential=result, window=window, palette=palette)
    return View(_PATH_LABELS, draw, window.ranges, f"{result.name}: {escape}", is_plane=True, is_equal=True)


def _draw_potential(axes: Axes, potential: Potential, window: Window, palette: Palette) -> list[Artist]:
    artists = draw_equipotentials(axes, potential, window)
    for channel, (x, y) in enumerate(potential.saddles.tolist(), 1):
        artists += axes.plot(x, y, "o", color=palette.channels[channel - 1], markeredgecolor=LIGHT.halo, zorder=3)
    return artists


@view_of.register
def _review_view(result: PotentialReview, palette: Palette) -> View:
    if result.refusal is not None:
        raise NoPictureError("a potential that cannot be used has no picture")
    return _potential_view(result.potential, palette)


@view_of.register
def _sweep_view(
    result: Sweep, palette: Palette, *, measure: str | None = None, outcome: int | None = None, cmap: Any = None, norm: Any = None
) -> View:
    if len(result.axes) > 1:
        return _plate_view(result, measure, outcome, cmap, norm)
    _check_scale(cmap, norm, has_scale=False)
    _check_no_outcome(outcome)
    charts = {chart.frame.name: chart for chart in charts_of(result, palette)}
    if not charts:
        raise NoPictureError(_NO_CURVES)
    # By default, the first measure.
    return _chart_view(charts[next(iter(charts)) if measure is None else checked_choice("measure", measure, charts)])
