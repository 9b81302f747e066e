"""Curves against energy and time drawn with Matplotlib: shares, decay laws, and single lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Curves, DecayLaws, EscapeStatistics, Fate, Outcome, Potential
from engine.measures.decay_laws import LawFit
from plots.figure_axes import add_panel_legend, label_axes, name_panel, new_figure, style_axes
from plots.figure_style import SCREEN, FigureStyle
from plots.palette import LAW_COLOURS, MEASURED, PAPER
from plots.statistics_charts import BINS, MOST_CROSSINGS

# Curves of channels that are equal by symmetry coincide: the second is dashed.
_DASHED = (0, (4.0, 3.0))
_SAMPLES = 300
# Height of the figure of curves, in units of its width: with two columns and with one.
_HEIGHT, _HEIGHT_OF_COLUMN = 1.2, 4.5
_ESCAPE_TIME = "Escape time"
# Curves of each panel but the first with their names, name of the axis, title.
_MEASURES: Sequence[tuple[Mapping[str, str], str, str]] = (
    ({"s_b": "$S_b$", "s_bb": "$S_{bb}$"}, "entropy", "Basin entropy"),
    ({"exponent": "α"}, "α", "Uncertainty exponent"),
    ({"mean_escape_time": "mean", "median_escape_time": "median"}, "escape time", _ESCAPE_TIME),
    ({"decay_rate": "κ"}, "κ", "Decay rate"),
    ({"bounded_area": "all", "largest_island": "largest island"}, "area", "Area of the bounded starts"),
)
# If more than this share remains, the curve is in the upper half of its panel.
_MOST_STAY = 0.4
_SYMBOLS = {"exponential": r"\kappa", "power law": r"\gamma"}
# Longer curves have no markers.
_MOST_MARKERS = 60
_DASHES = {"exponential": "--", "power law": "-."}


def draw_curves_figure(curves: Curves, style: FigureStyle) -> Figure:
    """Draw shares, basin entropies, uncertainty exponent, escape times, decay rate and islands against the energy or a parameter.

    Raises
    ------
    ValueError
        If there is no point yet.
    """
    if not curves.values.size:
        raise ValueError("curves: must have at least one point")
    columns = style.columns(2)
    spec = curves.spec
    title = (
        f"{spec.potential.name}, {spec.plane.title}, {spec.resolution[0]} × {spec.resolution[1]} starts, t_max = {spec.t_max:g}"
    )
    figure = new_figure(style, style.width * (_HEIGHT if columns == 2 else _HEIGHT_OF_COLUMN), title)
    panels = figure.subplots((1 + len(_MEASURES)) // columns, columns).ravel().tolist()
    draw_shares(panels[0], curves.values, curves.shares, spec.potential, style, spec.outcomes)
    for axes, (lines, up, words) in zip(panels[1:], _MEASURES, strict=True):
        _draw_measures(axes, curves, lines, style)
        label_axes(axes, spec.symbol, up, style)
        name_panel(axes, words, style)
        if words == _ESCAPE_TIME:
            axes.set_yscale("log")
    label_axes(panels[0], spec.symbol, "percentage of starts", style)
    name_panel(panels[0], "Shares of the interior starts", style)
    add_panel_legend(panels[0], "best", style)
    return figure


def _draw_measures(axes: Axes, curves: Curves, lines: Mapping[str, str], style: FigureStyle) -> None:
    for (name, label), colour in zip(lines.items(), (MEASURED, LAW_COLOURS["exponential"]), strict=False):
        axes.plot(curves.values, curves.curve(name), color=colour, linewidth=1.4, marker="o", markersize=2.2, label=label)
    axes.set_xlim(float(curves.values[0]), float(curves.values[-1]))
    style_axes(axes, style, grid=True)
    if len(lines) > 1:
        add_panel_legend(axes, "best", style)


def draw_statistics_figure(statistics: EscapeStatistics, style: FigureStyle) -> Figure:
    """Draw the histogram of escape times, and the probability of escape after each number of crossings."""
    columns = style.columns(2)
    figure = new_figure(style, style.width * (0.45 if columns == 2 else 1.6), "Statistics of the escapes")
    times, probabilities = figure.subplots(2 // columns, columns).ravel().tolist()
    draw_escape_times(times, statistics, style)
    name_panel(times, "Escape times", style)
    chances = statistics.escape_probabilities[: MOST_CROSSINGS + 1]
    probabilities.bar(np.arange(len(chances)), chances, color=MEASURED)
    probabilities.set_xlim(-0.6, MOST_CROSSINGS + 0.6)
    probabilities.set_ylim(0.0, 1.0)
    style_axes(probabilities, style, grid=True)
    label_axes(probabilities, "upward crossings n", "p", style)
    name_panel(probabilities, "Escapes after n crossings", style)
    return figure


def draw_escape_times(axes: Axes, statistics: EscapeStatistics, style: FigureStyle = SCREEN) -> None:
    """Draw the histogram of the escape times."""
    edges, counts = statistics.time_histogram(BINS)
    axes.stairs(counts, edges, fill=True, color=MEASURED)
    axes.set_xscale("log")
    style_axes(axes, style, grid=True)
    label_axes(axes, "escape time", "starts", style)


def draw_shares(
    axes: Axes,
    energies: np.ndarray,
    shares: np.ndarray,
    potential: Potential,
    style: FigureStyle = SCREEN,
    outcomes: Sequence[Outcome] | None = None,
) -> None:
    """Draw percentages (m, outcomes + 1), of bounded starts and of each outcome, against energy (m,).

    `outcomes` are those of the shares; None for those of the potential.
    """
    outcomes = potential.outcomes if outcomes is None else outcomes
    for code, share in enumerate(shares.T):
        if code == Fate.BOUNDED:
            line: dict[str, Any] = {"color": PAPER.bounded, "linewidth": 2.2, "label": PAPER.outcomes[Fate.BOUNDED].label}
        else:
            dashed = (
                potential.well.mirror_in_x and code <= len(potential.outcomes) and potential.well.mirror_channels[code] < code
            )
            entry = PAPER.entry(code, outcomes)
            line = {"color": entry.colour, "linewidth": 1.7, "label": entry.label}
            line |= {"linestyle": _DASHED, "zorder": 3} if dashed else {}
        axes.plot(energies, 100.0 * share, marker="o", markersize=2.2, **line)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlim(float(energies[0]), float(energies[-1]))
    style_axes(axes, style, grid=True)


def draw_decay_laws(axes: Axes, laws: DecayLaws, t_max: float) -> None:
    """Draw the share of starts that have not escaped against time until t_max, and its fits."""
    times = np.concatenate([[1.0], laws.times[laws.times > 1.0], [t_max]])
    steps = np.concatenate([[1.0], laws.survival[laws.times > 1.0], laws.survival[-1:] if laws.times.size else [1.0]])
    positive = steps > 0.0
    axes.step(times[positive], steps[positive], where="post", color=MEASURED, linewidth=1.8, label="starts")
    for fit in (laws.exponential, laws.power_law):
        if fit is not None:
            _draw_law(axes, fit, preferred=laws.preferred is fit.law)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1.0, t_max)
    # At least a decade, so that the axis has labels.
    axes.set_ylim(10.0 ** np.floor(np.log10(0.99 * steps[positive].min())), 1.4)
    style_axes(axes, grid=True)
    add_panel_legend(axes, "lower left" if steps[-1] > _MOST_STAY else "upper right")


def _draw_law(axes: Axes, fit: LawFit, *, preferred: bool) -> None:
    name = str(fit.law)
    label = f"{name}, ${_SYMBOLS[name]} = {_mathtext(fit.rate)}$" + (" (preferred)" if preferred else "")
    t = np.geomspace(fit.t_low, fit.t_high, _SAMPLES)
    curve = fit.curve(t)
    axes.plot(
        t, np.where(curve > 0.0, curve, np.nan), color=LAW_COLOURS[name], linewidth=1.8, linestyle=_DASHES[name], label=label
    )


def _mathtext(number: float) -> str:
    """Number to three digits, with a power of ten if it is small or large."""
    digits, _, power = f"{number:.2e}".partition("e")
    return f"{number:.3g}" if abs(int(power)) < 3 else rf"{digits} \times 10^{{{int(power)}}}"


def draw_line(axes: Axes, x: np.ndarray, y: np.ndarray, across: str, up: str, *, logarithmic: str = "") -> None:
    """Draw one measured curve; `logarithmic` has the letters of the axes with a logarithmic scale."""
    axes.plot(x, y, color=MEASURED, linewidth=1.4, marker="o" if x.size <= _MOST_MARKERS else "", markersize=3.0)
    if "x" in logarithmic:
        axes.set_xscale("log")
    if "y" in logarithmic:
        axes.set_yscale("log")
    style_axes(axes, grid=True)
    label_axes(axes, across, up)
