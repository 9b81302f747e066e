"""Charts of measures as data: series of points with their colours, axes and limits. The page and figures draw them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from engine import MEASURES, Measure
from engine.foundations.wording import format_number
from engine.results import DecayLaws, EscapeStatistics, LawFit, Sweep, UncertaintyExponent
from plots.pictures.histories import logarithmic_limits
from plots.pictures.palette import LAW_COLOURS, MEASURED, SET_ASIDE, THRESHOLD, Entry, Palette

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""

SHARES = MEASURES["shares"]
"""The measure of a sweep with a curve for each outcome."""

CURVE_PANELS = tuple(measure for measure in MEASURES.values() if measure.labels)
"""The other measures of a sweep that have a chart, in order."""

# Colours of the numbers of a measure, in order.
_NUMBER_COLOURS = MEASURED, LAW_COLOURS["exponential"]
# Number of points of the curve of a law.
_LAW_POINTS = 200
# Symbols of the rates of decay laws.
_RATE_SYMBOLS = {"exponential": "κ", "power law": "γ"}

# Margin of an axis that is fitted to its points, as a share of their range.
_MARGIN = 0.05

Limits = tuple[float, float]
"""Ends of an axis."""


class Shape(Enum):
    """How a series is drawn. Dashed lines are in front of other lines. Steps keep the y of a point until the next x."""

    LINE = auto()
    DASHED = auto()
    STEPS = auto()
    POINTS = auto()
    JOINED_POINTS = auto()
    BARS = auto()


@dataclass(frozen=True, eq=False)
class Series:
    """Points of one colour.

    Attributes
    ----------
    label
        Label in the legend; empty for a series without an entry.
    colour
        Colour of the points.
    x, y
        Coordinates of the points, of shape (n,).
    shape
        How the points are drawn.
    bars
        Lower and upper ends of the error bars; for `Shape.BARS`, left and right edges of the bars; None without bars.
    """

    label: str
    colour: str
    x: np.ndarray
    y: np.ndarray
    shape: Shape = Shape.LINE
    bars: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def curve(self) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the line through the points."""
        return (np.repeat(self.x, 2)[1:], np.repeat(self.y, 2)[:-1]) if self.shape is Shape.STEPS else (self.x, self.y)

    def extent(self, axis: str) -> tuple[np.ndarray, ...]:
        """Return the coordinates of the points along an axis, "x" or "y", and of the ends of the bars along it."""
        has_bars = self.bars is not None and (axis == "x") == (self.shape is Shape.BARS)
        return (self.x if axis == "x" else self.y), *(self.bars if has_bars and self.bars else ())


@dataclass(frozen=True)
class Frame:
    """What charts of different results have in common.

    Attributes
    ----------
    name
        Name of the chart and of its help text.
    title
        Title above the chart.
    labels
        Labels of both axes.
    logarithmic
        Letters of the logarithmic axes, such as "xy".
    level
        Value of a marked horizontal line with its label; None for no line.
    """

    name: str
    title: str
    labels: tuple[str, str]
    logarithmic: str = ""
    level: tuple[float, str] | None = None


@dataclass(frozen=True, eq=False)
class Chart:
    """Series in a frame. `limits` are those of the x axis and the y axis; None fits an axis to the points, see `axis_limits`."""

    frame: Frame
    series: Sequence[Series]
    limits: tuple[Limits | None, Limits | None] = (None, None)

    @property
    def axis_limits(self) -> tuple[Limits, Limits]:
        """The limits of both axes, which all renderers apply."""
        x, y = self.limits
        return x or self._fitted_limits("x"), y or self._fitted_limits("y")

    def _fitted_limits(self, axis: str) -> Limits:
        """Return limits a little beyond the points and bars of the series."""
        values = np.concatenate([np.zeros(0), *(part for one in self.series for part in one.extent(axis))])
        is_logarithmic = axis in self.frame.logarithmic
        values = values[np.isfinite(values) & ((values > 0.0) | (not is_logarithmic))]
        if not values.size:
            return (1.0, 100.0) if is_logarithmic else (0.0, 1.0)
        low, high = float(values.min()), float(values.max())
        if is_logarithmic:
            return logarithmic_limits(low, high)
        margin = _MARGIN * ((high - low) or abs(low) or 1.0)
        return low - margin, high + margin

    def legend(self) -> list[Entry]:
        """Return the entries of the legend."""
        level = [] if self.frame.level is None else [Entry(self.frame.level[1], THRESHOLD)]
        return [*(Entry(one.label, one.colour) for one in self.series if one.label), *level]


TIMES = Frame("histogram", "Escape times", ("escape time", "starts"), "x")
PROBABILITIES = Frame("probabilities", "Escapes after n crossings", ("upward crossings n", "p"))
SURVIVAL = Frame("survival", "Still inside", ("t", "share of the starts"), "xy")
PAIRS = Frame("uncertainty", "Uncertain pairs of starts", ("separation", "uncertain share"), "xy")


def measure_frame(measure: Measure, symbol: str = "") -> Frame:
    """Return the frame of a measure of sweeps along an axis with this symbol."""
    curve = measure.curve
    return Frame(measure.name, measure.title, (symbol, curve.axis), "y" if curve.logarithmic else "", curve.level)


def sweep_charts(curves: Sweep, palette: Palette) -> list[Chart]:
    """Return the charts of the measures that a sweep contains, the shares first."""
    shares = [_shares_chart(curves, palette)] if "share" in curves.dataset else []
    measures = (measure for measure in CURVE_PANELS if set(measure.labels) <= set(curves.dataset))
    return [*shares, *(_measure_chart(measure, curves) for measure in measures)]


def _measure_chart(measure: Measure, curves: Sweep) -> Chart:
    """Return the chart of the numbers of a measure with their error bars, against the energy or a parameter."""
    series = [
        Series(label, colour, curves.values, curves[name], Shape.JOINED_POINTS, curves.interval(name))
        for (name, label), colour in zip(measure.labels.items(), _NUMBER_COLOURS, strict=False)
    ]
    numbers = np.concatenate([values for one in series for values in (one.y, *(one.bars or ()))])
    numbers = numbers[np.isfinite(numbers)]
    limits: Limits | None = None
    if numbers.size and measure.curve.logarithmic:
        limits = logarithmic_limits(float(numbers.min()), float(numbers.max()))
    elif numbers.size:
        limits = 0.0, 1.05 * max([*numbers, measure.curve.least_top])
    return Chart(measure_frame(measure, curves.symbol), series, (_swept_limits(curves), limits))


def _shares_chart(curves: Sweep, palette: Palette) -> Chart:
    """Return the chart of the percentages of bounded starts and of each outcome."""
    entries = [Entry("bounded", palette.bounded), *palette.end_entries(curves.outcomes)]
    # Symmetric exits have equal shares: dashed curves leave the solid curves below visible.
    series = [
        Series(entry.label, entry.colour, curves.values, 100.0 * share, Shape.DASHED if _is_dashed(code) else Shape.LINE)
        for code, (entry, share) in enumerate(zip(entries, curves["share"].T, strict=True))
    ]
    return Chart(measure_frame(SHARES, curves.symbol), series, (_swept_limits(curves), (0.0, 100.0)))


def _is_dashed(code: int) -> bool:
    """Whether the curve of a fate is dashed: that of every second outcome. Code 0 stands for bounded starts."""
    return code > 0 and code % 2 == 0


def _swept_limits(curves: Sweep) -> Limits | None:
    requested = curves.dataset.attrs["requested"]
    return (requested[0], requested[-1]) if len(requested) > 1 else None


def times_chart(statistics: EscapeStatistics) -> Chart:
    """Return the histogram of the escape times."""
    edges, counts = statistics.time_histogram(BINS)
    bars = Series("", MEASURED, np.sqrt(edges[:-1] * edges[1:]), counts, Shape.BARS, (edges[:-1], edges[1:]))
    return Chart(TIMES, [bars], ((edges[0], edges[-1]), (0.0, 1.05 * max(float(counts.max()), 1.0))))


def probabilities_chart(statistics: EscapeStatistics) -> Chart:
    """Return the chart of the escape probability after each number of crossings."""
    probabilities = statistics.escape_probabilities[: MOST_CROSSINGS + 1]
    n = np.arange(probabilities.size, dtype=float)
    bars = Series("", MEASURED, n, probabilities, Shape.BARS, (n - 0.5, n + 0.5))
    highest = max(probabilities, default=0.0) or 1.0
    return Chart(PROBABILITIES, [bars], ((-0.6, MOST_CROSSINGS + 0.6), (0.0, 1.05 * float(highest))))


def survival_chart(laws: DecayLaws, t_end: float | None = None) -> Chart:
    """Return the chart of the share of survivors S(t) with the fitted laws, until `t_end` or a little beyond the last escape."""
    # A logarithmic axis cannot show 0.
    is_positive = (laws.survival > 0.0) & (laws.times > 0.0)
    times, shares = laws.times[is_positive], laws.survival[is_positive]
    # The chart begins at t = 1, or at a tenth of the last escape time if that is earlier. Without escapes, it also begins at 1.
    latest = float(times[-1]) if times.size else 10.0
    begin = min(1.0, 0.1 * latest)
    steps = np.vstack([[begin, 1.0], np.column_stack([times, shares])])
    if t_end is not None:
        steps = np.vstack([steps, [t_end, steps[-1, 1]]])
    fits = [fit for fit in (laws.exponential, laws.power_law) if fit is not None]
    survivors = Series("starts", MEASURED, steps[:, 0], steps[:, 1], Shape.STEPS)
    series = [survivors, *(_law_series(fit, preferred=laws.preferred is fit.law) for fit in fits)]
    return Chart(SURVIVAL, series, ((begin, t_end or 1.5 * latest), logarithmic_limits(0.99 * float(steps[:, 1].min()), 1.0)))


def _law_series(fit: LawFit, *, preferred: bool) -> Series:
    t = np.geomspace(fit.t_low, fit.t_high, _LAW_POINTS)
    share = fit.curve(t)
    label = f"{fit.law}, {_RATE_SYMBOLS[fit.law]} = {format_number(fit.rate, 3)}{' (preferred)' if preferred else ''}"
    return Series(label, LAW_COLOURS[fit.law], t[share > 0.0], share[share > 0.0], Shape.DASHED)


def pairs_chart(fit: UncertaintyExponent) -> Chart:
    """Return the chart of the uncertain share against separation, with the fitted power law."""
    separations, shares = fit.separations, fit.shares
    is_positive = shares > 0.0
    low, high = fit.share_intervals
    series: list[Series] = []
    if np.isfinite(fit.exponent):
        fitted = separations[fit.used]
        law = fit.amplitude * fitted**fit.exponent
        series.append(Series(f"α = {format_number(fit.exponent, 3)}", LAW_COLOURS["power law"], fitted, law))
    for label, colour, members in (("used", MEASURED, fit.used), ("not used", SET_ASIDE, ~fit.used)):
        is_shown = is_positive & members
        errors = low[is_shown], high[is_shown]
        points = Series(f"{label} for the exponent", colour, separations[is_shown], shares[is_shown], Shape.POINTS, errors)
        series += [points] if is_shown.any() else []
    limits = logarithmic_limits(float(shares[is_positive].min()), float(shares.max())) if is_positive.any() else None
    return Chart(PAIRS, series, ((0.5 * float(separations.min()), 2.0 * float(separations.max())), limits))
