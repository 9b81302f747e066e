"""What can be counted in a map, or in a rectangle of it: who leaves, where, when, and after how many crossings of y = 0."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from engine.arrays import read_only
from engine.dynamics.fates import Fate
from engine.dynamics.planes import Window
from engine.maps.result import EscapeMap

SURVIVAL_POINTS = 500
"""Most points of a survival curve."""

_LOWEST_CODE = int(min(Fate))
# Times this close, relatively, are one time: no bins fit between them.
_SAME_TIME = 1e-9
# A histogram of one time reaches from this share of it to its inverse.
_LOWER_SIDE = 0.5


@dataclass(frozen=True, eq=False)
class EscapeStatistics:
    """Counts of the interior starts of a map or of a part of it, as in Zotos (2014), section 5; arrays are read-only.

    Attributes
    ----------
    channel_counts
        How many left through channel 1, 2, … .
    bounded, undecided, failed
        How many are `Fate.BOUNDED`, `NOT_COMPUTED` (in a map under way, those not started yet included), `FAILED`.
    mean_escape_time, median_escape_time
        Of those that left, dimensionless; NaN when none did.
    crossing_counts
        (most crossings + 1,) int64: dN_n = those that left after exactly n upward crossings of y = 0; empty when none did.
    escape_times
        (escaped,) float64, of all that left, row by row.
    """

    channel_counts: tuple[int, ...]
    bounded: int
    undecided: int
    failed: int
    mean_escape_time: float
    median_escape_time: float
    crossing_counts: np.ndarray = field(repr=False)
    escape_times: np.ndarray = field(repr=False)

    @property
    def starts(self) -> int:
        """N0: all starts that exist and are not outside."""
        return self.decided + self.undecided + self.failed

    @property
    def decided(self) -> int:
        """Those known to have left or to be bounded."""
        return self.escaped + self.bounded

    @property
    def escaped(self) -> int:
        """Ne: those that left."""
        return sum(self.channel_counts)

    @property
    def direct(self) -> int:
        """Nde: those that left without crossing y = 0 upward."""
        return int(self.crossing_counts[:1].sum())

    @property
    def direct_share(self) -> float:
        """Nde / N0; 0 when there are no starts."""
        return self.direct / self.starts if self.starts else 0.0

    @property
    def shares(self) -> dict[int, float]:
        """Share of N0 for each channel, and for `Fate.BOUNDED`, `NOT_COMPUTED` and `FAILED`; 0 when there are no starts."""
        counts = dict(enumerate(self.channel_counts, start=1))
        counts |= {int(Fate.BOUNDED): self.bounded, int(Fate.NOT_COMPUTED): self.undecided, int(Fate.FAILED): self.failed}
        return {code: count / self.starts if self.starts else 0.0 for code, count in counts.items()}

    @property
    def escape_probabilities(self) -> np.ndarray:
        """p_n = dN_n / N_n, where N_n have not left before their n-th crossing; shaped like `crossing_counts`.

        N_0 are the decided starts, so that the product of all 1 − p_n is the bounded share of these. It is N0 in a finished
        map without failures; in one under way those that leave late are still missing, so every p_n may change.
        """
        left_before = np.cumsum(self.crossing_counts) - self.crossing_counts
        return read_only(self.crossing_counts / (self.decided - left_before))

    def time_histogram(self, bins: int) -> tuple[np.ndarray, np.ndarray]:
        """How many left when.

        Parameters
        ----------
        bins
            How many bins, 1 or more.

        Returns
        -------
        (bins + 1,) edges, evenly spaced on a logarithmic scale from the first escape to the last, and (bins,) int64 counts; the
        last bin holds its upper edge, the first one also escapes at t = 0. A single time stands between its half and its double;
        where nothing left, edges go from 0.5 to 2.

        Raises
        ------
        ValueError
            When `bins` is below 1.
        """
        if bins < 1:
            raise ValueError(f"bins={bins}: must be 1 or more")
        positive = self.escape_times[self.escape_times > 0.0]
        low, high = (float(positive.min()), float(positive.max())) if positive.size else (1.0, 1.0)
        if high <= low * (1.0 + _SAME_TIME):
            low, high = low * _LOWER_SIDE, high / _LOWER_SIDE
        edges = np.geomspace(low, high, bins + 1)
        place = np.clip(np.searchsorted(edges, self.escape_times, side="right") - 1, 0, bins - 1)
        return read_only(edges), read_only(np.bincount(place, minlength=bins))


def compute_statistics(frame: EscapeMap, window: Window | None = None) -> EscapeStatistics:
    """Count what a map, finished or under way, holds; forbidden and outside starts are left out.

    Parameters
    ----------
    frame
        The map.
    window
        Count only pixels whose centre lies in this rectangle, edges included; it may reach beyond the map or miss it. None for
        all.
    """
    part = _pixels_inside(frame, window)
    fate = frame.fate[part]
    left = fate >= 1
    times = frame.escape_time[part][left]
    highest = frame.spec.potential.channels
    counts = np.bincount(fate.ravel().astype(np.intp) - _LOWEST_CODE, minlength=highest + 1 - _LOWEST_CODE).tolist()
    return EscapeStatistics(
        channel_counts=tuple(counts[1 - _LOWEST_CODE :]),
        bounded=counts[Fate.BOUNDED - _LOWEST_CODE],
        undecided=counts[Fate.NOT_COMPUTED - _LOWEST_CODE],
        failed=counts[Fate.FAILED - _LOWEST_CODE],
        mean_escape_time=float(times.mean()) if times.size else float("nan"),
        median_escape_time=float(np.median(times)) if times.size else float("nan"),
        crossing_counts=read_only(np.bincount(frame.crossings[part][left])),
        escape_times=read_only(times),
    )


def compute_survival(statistics: EscapeStatistics) -> tuple[np.ndarray, np.ndarray]:
    """S(t): the share of the decided starts that are still inside just after t.

    Parameters
    ----------
    statistics
        The escapes. Starts under way count neither as inside nor as gone, so that S is too low at late times while there
        are many.

    Returns
    -------
    (m,) rising times of escapes, dimensionless, and (m,) S at these, both read-only: all steps, or some `SURVIVAL_POINTS` of
    them, even in ln t; the first and the last are always there. S is 1 before the first, and stays at the bounded share
    after the last. Empty when nothing left.
    """
    times, counts = np.unique(statistics.escape_times, return_counts=True)
    survival = 1.0 - np.cumsum(counts) / max(statistics.decided, 1)
    if times.size > SURVIVAL_POINTS:
        first = times[times > 0.0][0]
        grid = np.geomspace(first, times[-1], SURVIVAL_POINTS - 1)[:-1]
        kept = np.unique([0, *(np.searchsorted(times, grid, side="right") - 1), times.size - 1])
        times, survival = times[kept], survival[kept]
    return read_only(times), read_only(survival)


def _pixels_inside(frame: EscapeMap, window: Window | None) -> tuple[slice, slice]:
    """The rows and columns whose centres lie in the window."""
    if window is None:
        return slice(None), slice(None)
    rows = np.searchsorted(frame.ordinate, window.ordinate_low), np.searchsorted(frame.ordinate, window.ordinate_high, "right")
    columns = np.searchsorted(frame.x, window.x_low), np.searchsorted(frame.x, window.x_high, "right")
    return slice(*map(int, rows)), slice(*map(int, columns))
