"""Escape statistics of a map or of a window in it: outcomes, escape times and crossings of the section."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from engine.foundations.arrays import read_only
from engine.measures.basins.starts import Measurable, Starts, read_starts, wilson_interval
from engine.propagation.fates import Fate, OrbitResult
from engine.slices.window import GivenWindow, checked_window
from engine.systems.outcomes import Outcome

MAX_SURVIVAL_POINTS = 500
"""Largest number of points of a survival curve."""

# Lowest code of a fate, which is negative.
_LOWEST_CODE = int(min(Fate))
# Relative difference below which times count as equal, because no bins fit between them.
_TIME_TOLERANCE = 1e-9
# Lower edge of a histogram of equal times, as a share of the time; the upper edge is the time divided by this share.
_LOWER_EDGE = 0.5


@dataclass(frozen=True, eq=False, repr=False)
class EscapeStatistics(OrbitResult):
    """Counts of the interior starts of a map, of a part of it, or of any orbits (Zotos 2014, section 5); arrays are read-only.

    Attributes
    ----------
    channel_counts
        Number of escapes at each of the `outcomes`: through channel 1, 2, … and at other ends. Collisions count as escapes.
    bounded, undecided, failed
        Number of starts with the fate `Fate.BOUNDED`, `Fate.NOT_COMPUTED` (including orbits not started yet) and `Fate.FAILED`.
    mean_escape_time, median_escape_time
        Mean and median over the escapes, dimensionless; NaN without escapes.
    crossing_counts
        (most crossings + 1,) int64, dN_n: escapes after exactly n crossings of the section, by default of y = 0 upward; empty
        without escapes.
    escape_times
        (escaped,) float64, all escape times, row by row, dimensionless.
    t_max
        Integration time of the orbits, dimensionless; infinite if it is not known.
    outcomes
        The outcomes that are counted, see `Potential.outcomes`; empty if they are not known.
    """

    channel_counts: tuple[int, ...]
    bounded: int
    undecided: int
    failed: int
    mean_escape_time: float
    median_escape_time: float
    crossing_counts: np.ndarray = field(repr=False)
    escape_times: np.ndarray = field(repr=False)
    t_max: float = float("inf")
    outcomes: tuple[Outcome, ...] = field(default=(), repr=False)
    array_dimensions: ClassVar = {"escape_times": ("escape",)}
    held_as: ClassVar = OrbitResult.held_as | {"crossing_counts": "escapes"}

    @property
    def starts(self) -> int:
        """N0: number of starts that are neither forbidden nor outside."""
        return self.decided + self.undecided + self.failed

    @property
    def decided(self) -> int:
        """Number of starts known to escape or to be bounded."""
        return self.escaped + self.bounded

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return the escapes and the probability of an escape by the number of crossings before it."""
        counts = self.crossing_counts
        return {"crossings": np.arange(counts.size), "escapes": counts, "escape_probability": self.escape_probabilities}

    @property
    def escaped(self) -> int:
        """Ne: number of escapes."""
        return sum(self.channel_counts)

    @property
    def direct(self) -> int:
        """Nde: number of escapes without a crossing of the section, by default of y = 0 upward."""
        return int(self.crossing_counts[:1].sum())

    @property
    def direct_share(self) -> float:
        """Nde / N0; 0 without starts."""
        return self.direct / self.starts if self.starts else 0.0

    @property
    def shares(self) -> dict[int, float]:
        """Shares of N0 by fate: outcomes 1, 2, …, `Fate.BOUNDED`, `NOT_COMPUTED` and `FAILED`; 0 without starts."""
        counts = dict(enumerate(self.channel_counts, start=1))
        counts |= {int(Fate.BOUNDED): self.bounded, int(Fate.NOT_COMPUTED): self.undecided, int(Fate.FAILED): self.failed}
        return {code: count / self.starts if self.starts else 0.0 for code, count in counts.items()}

    @property
    def share_intervals(self) -> dict[int, tuple[float, float]]:
        """95 % Wilson interval of each of the `shares`, which holds for independent random starts."""
        limits = {code: wilson_interval(round(share * self.starts), self.starts) for code, share in self.shares.items()}
        return {code: (float(low), float(high)) for code, (low, high) in limits.items()}

    @property
    def escape_probabilities(self) -> np.ndarray:
        """p_n = dN_n / N_n, where N_n orbits have not escaped before their n-th crossing; shaped like `crossing_counts`.

        N_0 is the number of decided starts, so the product of all 1 − p_n is the bounded share of the decided starts. In a
        finished map without failures, N_0 is the number of starts. An unfinished map lacks late escapes, and all p_n can change.
        """
        escaped_before = np.cumsum(self.crossing_counts) - self.crossing_counts
        return read_only(self.crossing_counts / (self.decided - escaped_before))

    def time_histogram(self, bins: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute the histogram of the escape times.

        Parameters
        ----------
        bins
            Number of bins, 1 or more.

        Returns
        -------
        edges
            (bins + 1,) times, evenly spaced on a logarithmic scale from the first to the last escape; from half to twice the time
            if all times are equal, and from 0.5 to 2 without escapes.
        counts
            (bins,) int64. The last bin includes its upper edge, and the first bin includes escapes at t = 0.

        Raises
        ------
        ValueError
            If `bins` is below 1.
        """
        if bins < 1:
            raise ValueError(f"bins={bins}: must be 1 or more")
        positive = self.escape_times[self.escape_times > 0.0]
        low, high = (float(positive.min()), float(positive.max())) if positive.size else (1.0, 1.0)
        if high <= low * (1.0 + _TIME_TOLERANCE):
            low, high = low * _LOWER_EDGE, high / _LOWER_EDGE
        edges = np.geomspace(low, high, bins + 1)
        return read_only(edges), read_only(np.histogram(np.maximum(self.escape_times, low), edges)[0])


def compute_statistics(frame: Measurable | Starts, window: GivenWindow | None = None) -> EscapeStatistics:
    """Count the fates, crossings and escape times of a map, finished or not, or of any orbits.

    Forbidden and outside starts are left out.

    Parameters
    ----------
    frame
        The map, or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep; or the outcomes of `classify_orbits`.
    window
        Rectangle, given as in `MapSpec`. Only pixels whose centres lie in the rectangle, edges included, count. The rectangle can
        extend beyond the map or miss the map. None for all pixels, and for orbits that do not form a map.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_statistics
    >>> statistics = compute_statistics(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.6, (40, 40), t_max=1e3)))
    >>> statistics.starts, statistics.channel_counts, round(statistics.median_escape_time, 2)
    (1124, (496, 496, 66, 66), 1.51)
    """
    starts = read_starts("frame", frame)
    made_by = dict(starts.made_by)
    if window is not None:
        rectangle = checked_window(window)
        starts = starts.inside(rectangle)
        made_by["counted_in"] = rectangle.edges
    has_escaped = starts.fate >= 1
    times = starts.escape_time[has_escaped]
    # The number of starts by code; the lowest code has index 0.
    code_count = len(starts.outcomes) + 1 - _LOWEST_CODE
    counts = np.bincount(starts.fate.ravel().astype(np.intp) - _LOWEST_CODE, minlength=code_count).tolist()
    return EscapeStatistics(
        channel_counts=tuple(counts[1 - _LOWEST_CODE :]),
        bounded=counts[Fate.BOUNDED - _LOWEST_CODE],
        undecided=counts[Fate.NOT_COMPUTED - _LOWEST_CODE],
        failed=counts[Fate.FAILED - _LOWEST_CODE],
        mean_escape_time=float(times.mean()) if times.size else float("nan"),
        median_escape_time=float(np.median(times)) if times.size else float("nan"),
        crossing_counts=np.bincount(starts.crossings[has_escaped]),
        escape_times=times,
        t_max=starts.t_max,
        outcomes=starts.outcomes,
        made_by=made_by,
    )


def compute_survival(statistics: EscapeStatistics) -> tuple[np.ndarray, np.ndarray]:
    """Compute S(t), the share of the decided starts that are still inside just after t.

    Parameters
    ----------
    statistics
        The escapes. Undecided starts count neither as inside nor as escaped. In an unfinished map, S is therefore too small at
        late times.

    Returns
    -------
    times
        (m,) increasing escape times, dimensionless; read-only. All times, or about `MAX_SURVIVAL_POINTS` evenly spaced in ln t,
        including the first and the last. Empty without escapes.
    survival
        (m,) S at these times; read-only. S is 1 before the first time and constant after the last.
    """
    times, counts = np.unique(statistics.escape_times, return_counts=True)
    survival = 1.0 - np.cumsum(counts) / max(statistics.decided, 1)
    if times.size > MAX_SURVIVAL_POINTS:
        # The grid begins at the first positive time. The first time of all, which can be 0, is added below.
        first_positive = times[times > 0.0][0]
        grid = np.geomspace(first_positive, times[-1], MAX_SURVIVAL_POINTS - 1)[:-1]
        selected = np.unique([0, *(np.searchsorted(times, grid, side="right") - 1), times.size - 1])
        times, survival = times[selected], survival[selected]
    return read_only(times), read_only(survival)
