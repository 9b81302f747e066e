"""Limits, colours and curves of the charts of statistics and sweeps.

A sweep has a panel for the shares, and one for each other measure.
"""

from __future__ import annotations

import numpy as np

from engine import MEASURES, Measure
from engine.measures.decay_laws import LawFit
from engine.results import Sweep
from plots.pictures.palette import LAW_COLOURS, MEASURED

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""

SHARES = MEASURES["shares"]
"""The measure of the first panel, with a curve for each outcome."""

CURVE_PANELS = tuple(measure for measure in MEASURES.values() if measure.labels)
"""The measures of the other panels, in order."""

NUMBER_COLOURS = MEASURED, LAW_COLOURS["exponential"]
"""Colours of the numbers of a measure, in order."""

# Number of points of the curve of a law.
_LAW_POINTS = 200


def is_measured(measure: Measure, curves: Sweep) -> bool:
    """Return whether a sweep contains a measure."""
    return set(measure.labels) <= set(curves.dataset)


def find_numbers(measure: Measure, curves: Sweep) -> np.ndarray:
    """Return all numbers of a panel without NaN, including the ends of error bars."""
    values = np.concatenate([np.concatenate([curves[name], *curves.interval(name)]) for name in measure.labels])
    return values[np.isfinite(values)]


def law_curve(fit: LawFit) -> tuple[np.ndarray, np.ndarray]:
    """Return the times and the shares above 0 of a fitted law, each of shape (n,). A logarithmic axis cannot show 0."""
    t = np.geomspace(fit.t_low, fit.t_high, _LAW_POINTS)
    share = fit.curve(t)
    return t[share > 0.0], share[share > 0.0]
