"""Draw curves against energy and time with Matplotlib: shares, decay laws, and single lines."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Fate, Measure, Outcome
from engine.measures.decay_laws import LawFit
from engine.results import DecayLaws, EscapeStatistics, Sweep
from plots.pictures.charts import BINS, CURVE_PANELS, MOST_CROSSINGS, NUMBER_COLOURS, SHARES, is_measured, law_curve
from plots.pictures.palette import LAW_COLOURS, MEASURED, PAPER, THRESHOLD
from plots.printed.figure_axes import add_panel_legend, label_axes, new_figure, set_title, style_axes
from plots.printed.figure_style import SCREEN, FigureStyle

# Dashes of the second of two equal curves, such as the shares of mirror-image channels, so that both are visible.
_DASHED = (0, (4.0, 3.0))
# Height of the figure of curves with two columns, in units of the width.
_HEIGHT = 1.2
# Height of the figure of curves with one column, in units of the width.
_ONE_COLUMN_HEIGHT = 4.5
# Largest share of remaining starts for which the curve of survivors leaves the upper right corner free.
_MOST_SURVIVORS = 0.4
# Symbols of the rates of decay laws.
_RATE_SYMBOLS = {"exponential": r"\kappa", "power law": r"\gamma"}
# Largest number of points of a curve with markers.
_MOST_MARKERS = 60
# Line styles of decay laws.
_LAW_DASHES = {"exponential": "--", "power law": "-."}


def draw_curves_figure(curves: Sweep, style: FigureStyle) -> Figure:
    """Draw the shares and the other measures of a sweep against the energy or a parameter, with their error bars.

    Raises
    ------
    ValueError
        If there is no point yet.
    """
    if not curves.values.size:
        raise ValueError("curves: must have at least one point")
    columns = style.columns(2)
    request = curves.dataset.attrs
    starts = " × ".join(str(side) for side in request["resolution"])
    title = f"{request['potential']}, {request['plane']}, {starts} starts, t_max = {request['t_max']:g}"
    figure = new_figure(style, style.width * (_HEIGHT if columns == 2 else _ONE_COLUMN_HEIGHT), title)
    measures = [measure for measure in CURVE_PANELS if is_measured(measure, curves)]
    grid = np.ravel(figure.subplots(math.ceil((1 + len(measures)) / columns), columns)).tolist()
    draw_shares(grid[0], curves.values, curves["share"], curves.outcomes, style)
    label_axes(grid[0], curves.symbol, SHARES.curve.axis, style)
    set_title(grid[0], SHARES.title, style)
    add_panel_legend(grid[0], "best", style)
    for axes, measure in zip(grid[1:], measures, strict=False):
        draw_measure(axes, curves, measure, style)
        set_title(axes, measure.title, style)
    for axes in grid[1 + len(measures) :]:
        axes.remove()
    return figure


def draw_measure(axes: Axes, curves: Sweep, measure: Measure, style: FigureStyle = SCREEN) -> None:
    """Draw the numbers of a measure against the energy or a parameter, with their error bars."""
    curve = measure.curve
    for (name, label), colour in zip(measure.labels.items(), NUMBER_COLOURS, strict=False):
        # Matplotlib typesets a subscript such as S_b between dollar signs.
        typeset_label = re.sub(r"_(\w+)", r"$_{\1}$", label)
        axes.plot(curves.values, curves[name], color=colour, linewidth=1.4, marker="o", markersize=2.2, label=typeset_label)
        axes.fill_between(curves.values, *curves.interval(name), color=colour, alpha=0.25, linewidth=0.0)
    if curve.level is not None:
        axes.axhline(curve.level[0], color=THRESHOLD, linestyle="--", linewidth=1.2, label=curve.level[1])
    if curve.logarithmic:
        axes.set_yscale("log")
    axes.set_xlim(float(curves.values[0]), float(curves.values[-1]))
    style_axes(axes, style, grid=True, labels=(curves.symbol, curve.axis))
    if len(axes.lines) > 1:
        add_panel_legend(axes, "best", style)


def draw_statistics_figure(statistics: EscapeStatistics, style: FigureStyle) -> Figure:
    """Draw the histogram of escape times, and the probability of escape after each number of crossings."""
    columns = style.columns(2)
    figure = new_figure(style, style.width * (0.45 if columns == 2 else 1.6), "Statistics of the escapes")
    time_axes, crossing_axes = figure.subplots(2 // columns, columns).ravel().tolist()
    draw_escape_times(time_axes, statistics, style)
    set_title(time_axes, "Escape times", style)
    probabilities = statistics.escape_probabilities[: MOST_CROSSINGS + 1]
    crossing_axes.bar(np.arange(len(probabilities)), probabilities, color=MEASURED)
    crossing_axes.set_xlim(-0.6, MOST_CROSSINGS + 0.6)
    crossing_axes.set_ylim(0.0, 1.0)
    style_axes(crossing_axes, style, grid=True, labels=("upward crossings n", "p"), title="Escapes after n crossings")
    return figure


def draw_escape_times(axes: Axes, statistics: EscapeStatistics, style: FigureStyle = SCREEN) -> None:
    """Draw the histogram of the escape times."""
    edges, counts = statistics.time_histogram(BINS)
    axes.stairs(counts, edges, fill=True, color=MEASURED)
    axes.set_xscale("log")
    style_axes(axes, style, grid=True, labels=("escape time", "starts"))


def draw_shares(
    axes: Axes, energies: np.ndarray, shares: np.ndarray, outcomes: Sequence[Outcome], style: FigureStyle = SCREEN
) -> None:
    """Draw shares of bounded starts and each outcome, of shape (m, outcomes + 1), in percent against energies, of shape (m,)."""
    for code, share in enumerate(shares.T):
        if code == Fate.BOUNDED:
            line: dict[str, Any] = {"color": PAPER.bounded, "linewidth": 2.2, "label": PAPER.outcomes[Fate.BOUNDED].label}
        else:
            is_dashed = any(np.array_equal(share, earlier_share) for earlier_share in shares.T[1:code])
            entry = PAPER.entry(code, outcomes)
            line = {"color": entry.colour, "linewidth": 1.7, "label": entry.label}
            if is_dashed:
                line |= {"linestyle": _DASHED, "zorder": 3}
        axes.plot(energies, 100.0 * share, marker="o", markersize=2.2, **line)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlim(float(energies[0]), float(energies[-1]))
    style_axes(axes, style, grid=True)


def draw_decay_laws(axes: Axes, laws: DecayLaws, t_max: float) -> None:
    """Draw the share of starts that have not escaped, with its fits, against time until t_max."""
    times = np.concatenate([[1.0], laws.times[laws.times > 1.0], [t_max]])
    last_survival = laws.survival[-1] if laws.times.size else 1.0
    survival = np.concatenate([[1.0], laws.survival[laws.times > 1.0], [last_survival]])
    # A logarithmic axis cannot show 0.
    is_positive = survival > 0.0
    axes.step(times[is_positive], survival[is_positive], where="post", color=MEASURED, linewidth=1.8, label="starts")
    for fit in (laws.exponential, laws.power_law):
        if fit is not None:
            _draw_law(axes, fit, preferred=laws.preferred is fit.law)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1.0, t_max)
    # The factor 0.99 makes the axis span at least a decade, so that it has labels.
    axes.set_ylim(10.0 ** np.floor(np.log10(0.99 * survival[is_positive].min())), 1.4)
    style_axes(axes, grid=True)
    add_panel_legend(axes, "lower left" if survival[-1] > _MOST_SURVIVORS else "upper right")


def _draw_law(axes: Axes, fit: LawFit, *, preferred: bool) -> None:
    name = str(fit.law)
    label = f"{name}, ${_RATE_SYMBOLS[name]} = {_mathtext(fit.rate)}$" + (" (preferred)" if preferred else "")
    axes.plot(*law_curve(fit), color=LAW_COLOURS[name], linewidth=1.8, linestyle=_LAW_DASHES[name], label=label)


def _mathtext(number: float) -> str:
    """Write a number to three digits, with a power of ten if the number is small or large."""
    digits, _, power = f"{number:.2e}".partition("e")
    return f"{number:.3g}" if abs(int(power)) < 3 else rf"{digits} \times 10^{{{int(power)}}}"


def draw_line(axes: Axes, x: np.ndarray, y: np.ndarray, x_label: str, y_label: str, *, logarithmic: str = "") -> None:
    """Draw one measured curve. `logarithmic` contains the letters of the logarithmic axes, such as "xy"."""
    axes.plot(x, y, color=MEASURED, linewidth=1.4, marker="o" if x.size <= _MOST_MARKERS else "", markersize=3.0)
    if "x" in logarithmic:
        axes.set_xscale("log")
    if "y" in logarithmic:
        axes.set_yscale("log")
    style_axes(axes, grid=True, labels=(x_label, y_label))
