"""Charts of measures of one map: the survival curve with its laws, and the uncertain pairs of starts."""

from __future__ import annotations

import numpy as np

from engine.foundations.wording import format_number
from engine.results import DecayLaws, LawFit, UncertaintyExponent
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.histories import logarithmic_limits
from plots.pictures.palette import LAW_COLOURS, MEASURED, SET_ASIDE

# Number of points of the curve of a law.
_LAW_POINTS = 200
# Symbols of the rates of decay laws.
_RATE_SYMBOLS = {"exponential": "κ", "power law": "γ"}

SURVIVAL = Frame(
    "survival",
    "Still inside",
    ("t", "share of the starts"),
    "The share of the interior starts that have not escaped by time t. For fully chaotic motion it decreases exponentially; "
    "orbits that stick to islands of regular motion escape by a slower law, a power of time, which is a straight line on these "
    "axes. A law is named only if it fits and is significantly more likely than the other one.",
    "<b>$snap_y{percent}</b> are still inside<br>at t = $snap_x{number}: @label",
    Shape.LINE,
    logarithmic="xy",
)
PAIRS = Frame(
    "uncertainty",
    "Uncertain pairs of starts",
    ("separation", "uncertain share"),
    "Random pairs of starts at a given distance: the share of pairs with different fates, against the distance. Near a smooth "
    "boundary the share is proportional to the distance. Near a fractal boundary it decreases more slowly, as the distance to "
    "the power α, and the dimension of the boundary is 2 − α. Bars are 95 % intervals of the shares.",
    "<b>@y{percent}</b> of the pairs have different fates<br>at a separation of @x{number}, @label<br>"
    "95 % interval @low{percent} to @high{percent}",
    logarithmic="xy",
)


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
