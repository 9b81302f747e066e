"""Choose the logarithmic colour scale of escape times."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from engine import EscapeMap, Fate

# Share of the escape times that are below the scale, and equal share above the scale.
_OMITTED_SHARE = 0.01
# Smallest lower end of a fitted scale (dimensionless time). An orbit that starts at an exit escapes at once.
_LEAST_LOW_END = 0.1
# Smallest length of a long scale, in powers of ten. Long scales end at round numbers, so they seldom change between maps.
_LONG_SCALE_DECADES = 1.0
# Ends of long scales, in units of a power of ten.
_ROUND_STEPS = (1.0, 2.0, 5.0, 10.0)
# Ends of short scales, in units of a power of ten.
_FINE_STEPS = tuple(tenth / 10.0 for tenth in range(10, 101))


@dataclass(frozen=True)
class TimeScale:
    """A scale of escape times. The colours at its ends stand for all shorter and all longer times.

    Parameters
    ----------
    low, high
        Ends of the scale, dimensionless times; 0 < low < high.

    Raises
    ------
    ValueError
        If the ends are not finite, not positive or not in this order.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        if not 0.0 < self.low < self.high < math.inf:
            raise ValueError(f"low={self.low}, high={self.high}: must be positive and finite, low below high")

    def classes(self, times: np.ndarray, count: int) -> np.ndarray:
        """Return the index of the colour of each time, of shape (n,), out of `count` colours."""
        share = np.log(np.clip(times, self.low, self.high) / self.low) / math.log(self.high / self.low)
        return np.minimum((share * count).astype(int), count - 1)


WITHOUT_ESCAPES = TimeScale(1.0, 100.0)
"""The scale of a map without escapes."""


def fitted_scale(frame: EscapeMap) -> TimeScale:
    """Return the scale from the 1st to the 99th percentile of a map's escape times.

    The ends are rounded outward: to 1, 2 or 5 · 10^k, or to two digits if they differ by less than a factor of ten.
    """
    times = frame.escape_time[frame.fate > Fate.BOUNDED]
    if times.size == 0:
        return WITHOUT_ESCAPES
    low, high = np.maximum(np.quantile(times, (_OMITTED_SHARE, 1.0 - _OMITTED_SHARE)), _LEAST_LOW_END)
    steps = _ROUND_STEPS if math.log10(high / low) >= _LONG_SCALE_DECADES else _FINE_STEPS
    lower = _round(low, steps, up=False)
    upper = _round(high, steps, up=True)
    if lower == upper:
        upper = _round(1.01 * upper, steps, up=True)
    return TimeScale(lower, upper)


def common_scale(frames: Iterable[EscapeMap]) -> TimeScale:
    """Return the shortest scale that contains the fitted scales of several maps."""
    scales = [fitted_scale(frame) for frame in frames]
    return TimeScale(min(scale.low for scale in scales), max(scale.high for scale in scales))


def _round(number: float, steps: tuple[float, ...], *, up: bool) -> float:
    """Round a positive number up or down to a multiple of a power of ten. `steps` are the allowed factors."""
    # `math.log10` could be rounded up to the next whole number. The notation with all digits has the exact exponent.
    power = 10.0 ** int(f"{number:.16e}".partition("e")[2])
    candidates = [float(f"{step * power:.6g}") for step in steps]
    if up:
        return min(candidate for candidate in candidates if candidate >= number)
    return max(candidate for candidate in candidates if candidate <= number)
