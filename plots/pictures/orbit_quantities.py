"""Define the quantities of an orbit that are drawn against time: SALI, the Lyapunov exponent and R²."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from engine import Orbit
from engine.foundations.wording import format_number
from engine.propagation.fates import CHAOS_THRESHOLD
from plots.pictures.histories import History, logarithmic_limits, reduce_history

# Lower end of the axis of SALI.
_LEAST_SALI = 1e-17
# Upper end of the axis of SALI.
_LARGEST_SALI = 10.0
# Lower end of the axis of the Lyapunov exponent.
_LEAST_EXPONENT = 1e-7
# Upper end of the axis of the Lyapunov exponent, unless an orbit has a larger one.
_USUAL_EXPONENT = 1.0
# Smallest upper end of the axis of R².
_LEAST_R2 = 1e-3


@dataclass(frozen=True)
class OrbitQuantity:
    """A quantity of an orbit against time.

    Attributes
    ----------
    name
        Name in files, and value of the option `show` of `Orbit.plot`.
    title
        Title of the plot.
    label
        Label of the axis.
    values
        Returns the values at all times of an orbit, of shape (n,).
    limits
        Returns the ends of the axis for histories that have samples.
    least
        Lower end of a logarithmic axis. Smaller values are drawn there. None for a linear axis.
    threshold
        Value to be marked; None if there is none.
    ticks
        Positions of the labels of the axis; empty if the plot chooses them.
    """

    name: str
    title: str
    label: str
    values: Callable[[Orbit], np.ndarray]
    limits: Callable[[Sequence[History]], tuple[float, float]]
    least: float | None = None
    threshold: float | None = None
    ticks: tuple[float, ...] = ()

    @property
    def logarithmic(self) -> bool:
        """Whether the axis is logarithmic."""
        return self.least is not None

    def history(self, orbit: Orbit, part: slice) -> History:
        """Return the quantity over some samples of an orbit, without the sample at t = 0."""
        first = 1 if orbit.t[0] == 0.0 else 0
        samples = slice(max(part.start or 0, first), part.stop)
        values = self.values(orbit)[samples]
        if self.least is not None:
            values = np.maximum(values, self.least)
        return reduce_history(orbit.t[samples], values, logarithmic=self.logarithmic)


def _sali_limits(histories: Sequence[History]) -> tuple[float, float]:
    """Return limits at least five powers of ten apart, so that the curve of a regular orbit looks level."""
    lowest = min(float(history.line[1].min()) for history in histories)
    return min(1e-4, max(_LEAST_SALI, logarithmic_limits(lowest, _LARGEST_SALI)[0])), _LARGEST_SALI


def _exponent_limits(histories: Sequence[History]) -> tuple[float, float]:
    """Return limits from the power of ten below the last values to above all values, with at least two labels."""
    lowest = min(float(history.line[1][-1]) for history in histories)
    low, high = logarithmic_limits(lowest, max(history.highest for history in histories))
    return min(1e-2, low), max(_USUAL_EXPONENT, high)


def _r2_limits(histories: Sequence[History]) -> tuple[float, float]:
    return 0.0, 1.05 * max(_LEAST_R2, *(history.highest for history in histories))


ORBIT_QUANTITIES = (
    OrbitQuantity(
        "sali",
        f"SALI (chaotic at or below {format_number(CHAOS_THRESHOLD)})",
        "SALI",
        lambda orbit: orbit.sali,
        _sali_limits,
        least=_LEAST_SALI,
        threshold=CHAOS_THRESHOLD,
        ticks=(1e-16, 1e-12, 1e-8, 1e-4, 1.0),
    ),
    OrbitQuantity(
        "exponent",
        "Lyapunov exponent until t",
        "(1/t) ln|w|",
        lambda orbit: orbit.lyapunov_exponent,
        _exponent_limits,
        least=_LEAST_EXPONENT,
        ticks=(1e-6, 1e-4, 1e-2, 1.0),
    ),
    OrbitQuantity("r2", "R² = x² + y²", "R²", lambda orbit: orbit.r2, _r2_limits),
)
"""The quantities, in the order of the page."""
