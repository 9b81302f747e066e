"""Panels of the curves of a sweep, besides that of the shares: what each shows, on the page and in figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from engine import Sweep

SHARES_TITLE = "Shares of the interior starts"


@dataclass(frozen=True)
class CurvePanel:
    """A panel of one or two curves.

    Attributes
    ----------
    name, title
        Its name on the page and its title.
    axis
        Label of the vertical axis.
    labels
        Labels of the curves, by the variable of the sweep.
    bars
        What the error bars are; empty if there are none.
    logarithmic
        Whether the vertical axis is.
    least_top
        Least height of a linear axis, which begins at 0.
    level
        Height of a marked line, and its label.
    """

    name: str
    title: str
    axis: str
    labels: Mapping[str, str]
    bars: str = ""
    logarithmic: bool = False
    least_top: float = 1e-6
    level: tuple[float, str] | None = None

    def is_of(self, curves: Sweep) -> bool:
        """Whether a sweep has its measures."""
        return set(self.labels) <= set(curves.dataset)

    def find_numbers(self, curves: Sweep) -> np.ndarray:
        """All its numbers, ends of error bars included, without NaN."""
        values = np.concatenate([np.concatenate([curves[name], *curves.interval(name)]) for name in self.labels])
        return values[np.isfinite(values)]


CURVE_PANELS = (
    CurvePanel(
        "entropies", "Basin entropy", "entropy", {"s_b": "S_b", "s_bb": "S_bb"}, "standard error", least_top=0.72,
        level=(math.log(2.0), "ln 2"),
    ),
    CurvePanel("exponents", "Uncertainty exponent", "α", {"exponent": "α"}, "95 % interval", least_top=1.0),
    CurvePanel(
        "escapes", "Escape time", "escape time", {"mean_escape_time": "mean", "median_escape_time": "median"}, logarithmic=True
    ),
    CurvePanel(
        "islands", "Area of the bounded starts", "area", {"bounded_area": "all islands", "largest_island": "the largest"}
    ),
    CurvePanel("decays", "Decay rate", "κ", {"decay_rate": "κ"}, "95 % interval"),
    CurvePanel("boundaries", "Distance of the boundaries", "pixels", {"wada_distance": "99 % of the boundary"}, least_top=10.0),
)  # fmt: skip
"""The panels in their order."""
