"""Limits of the charts of statistics and curves. A sweep has a panel for the shares, and a panel for each other measure."""

from __future__ import annotations

import numpy as np

from engine import MEASURES, Measure
from engine.results import Sweep

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""

SHARES = MEASURES["shares"]
"""The measure of the first panel, with a curve for each outcome."""

CURVE_PANELS = tuple(measure for measure in MEASURES.values() if measure.labels)
"""The measures of the other panels, in order."""


def is_measured(measure: Measure, curves: Sweep) -> bool:
    """Return whether a sweep contains a measure."""
    return set(measure.labels) <= set(curves.dataset)


def find_numbers(measure: Measure, curves: Sweep) -> np.ndarray:
    """Return all numbers of a panel without NaN, including the ends of error bars."""
    values = np.concatenate([np.concatenate([curves[name], *curves.interval(name)]) for name in measure.labels])
    return values[np.isfinite(values)]
