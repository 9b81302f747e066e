"""Shares of the exits through which orbits leave, for each exit through which they entered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from engine.foundations.validation import checked_integers
from engine.foundations.wording import format_share
from engine.measures.basins.starts import Measurable, Starts, read_starts, wilson_interval
from engine.propagation.fates import Fate, OrbitResult, name_fate
from engine.systems.outcomes import Outcome


@dataclass(frozen=True, eq=False, repr=False)
class ExitMatching(OrbitResult):
    """Counts of entering orbits by entrance and exit; arrays are read-only.

    Attributes
    ----------
    entrances
        (m,) numbers of the exits through which orbits enter.
    ends
        (k,) fates of orbits: `Fate.BOUNDED` for orbits that stay until t_max, and the numbers of the outcomes that can occur.
    counts
        (m, k) numbers of orbits with each entrance and end. Orbits whose integration failed do not count.
    outcomes
        The outcomes to which the numbers of exits refer, see `Potential.outcomes`.
    """

    entrances: np.ndarray
    ends: np.ndarray
    counts: np.ndarray
    outcomes: tuple[Outcome, ...] = ()
    codes: ClassVar = {"exit": Fate}
    row_dimension: ClassVar = "pair"
    array_dimensions: ClassVar = {"entrances": ("entered",), "ends": ("ended",), "counts": ("entered", "ended")}

    @property
    def shares(self) -> np.ndarray:
        """(m, k) share of each end among the orbits of an entrance; NaN without orbits."""
        totals = self.counts.sum(axis=1, keepdims=True)
        return np.where(totals > 0, self.counts / np.maximum(totals, 1), np.nan)

    @property
    def share_intervals(self) -> tuple[np.ndarray, np.ndarray]:
        """(m, k) lower and upper limits of the 95 % Wilson intervals of the shares."""
        return wilson_interval(self.counts, self.counts.sum(axis=1, keepdims=True))

    @property
    def returning_share(self) -> float:
        """Share of the orbits that leave through the exit through which they entered; NaN without orbits."""
        total = int(self.counts.sum())
        returning_counts = self.counts[self.entrances[:, None] == self.ends]
        return float(returning_counts.sum()) / total if total else float("nan")

    def name_ends(self) -> Sequence[str]:
        """Return the names of the ends, (k,)."""
        return ["stays" if end == Fate.BOUNDED else name_fate(end, self.outcomes) for end in self.ends.tolist()]

    def numbers(self) -> dict[str, Any]:
        """Return the number of orbits, and the `returning_share`."""
        return {"orbits": int(self.counts.sum()), "returning_share": self.returning_share}

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return a row for each pair of an entrance and an end."""
        entrance, end = (grid.ravel() for grid in np.meshgrid(self.entrances, self.ends, indexing="ij"))
        low, high = self.share_intervals
        numbers = {"count": self.counts, "share": self.shares, "share_low": low, "share_high": high}
        return {"entrance": entrance, "exit": end, **{name: values.ravel() for name, values in numbers.items()}}

    def describe(self) -> str:
        """Return the shares of the orbits that leave through their entrance, and of those that stay, in a sentence."""
        total = int(self.counts.sum())
        staying_count = int(self.counts[:, self.ends == Fate.BOUNDED].sum())
        if not total:
            return "No orbit enters."
        returning = f"{format_share(self.returning_share)} leave through the exit by which they entered"
        return f"Of {total} orbits that enter {returning}, and {format_share(staying_count / total)} stay."


def compute_exit_matching(entrances: Any, outcomes: Measurable | Starts) -> ExitMatching:
    """Count entering orbits by the exit through which they enter and the exit through which they leave.

    If the exits of orbits are independent of their entrances, the shares are the same for all entrances: those of the exits in
    the flux. Differences are due to orbits that pass quickly along the tubes that connect entrances and exits. This is called
    "dynamical matching" (Collins, Kramer, Carpenter, Ezra & Wiggins 2014, J. Chem. Phys. 141, 034111).

    Parameters
    ----------
    entrances
        (n,) number of the exit through which each orbit entered, 1 or more, as returned by `sample_entrances_by_exit`.
    outcomes
        The outcomes of these orbits, from `classify_orbits`.

    Returns
    -------
    The `ExitMatching`; `to_pandas` has a row for each pair of an entrance and an end, with 95 % intervals.

    Raises
    ------
    ValueError
        If `entrances` are not one positive integer per orbit.

    Examples
    --------
    >>> from escape_explorer import CASES, classify_orbits, compute_exit_matching, sample_entrances_by_exit
    >>> entrances, starts = sample_entrances_by_exit(CASES["III"], 0.6, 3000, rng=1)
    >>> matching = compute_exit_matching(entrances, classify_orbits(CASES["III"], 0.6, starts, t_max=1e3))
    >>> matching.shares[0].round(1).tolist()  # that stay, and leave through exits 1 to 4: most through the opposite one
    [0.0, 0.0, 0.1, 0.9, 0.0]
    """
    starts, entered = read_starts("outcomes", outcomes), checked_integers("entrances", entrances)
    if entered.shape != starts.fate.shape or entered.ndim != 1 or (entered.size and entered.min() < 1):
        raise ValueError(f"entrances of shape {entered.shape}: must be one integer of 1 or more per orbit, {starts.fate.shape}")
    # If the outcomes are not known, the largest fate is their number.
    outcome_count = max([len(starts.outcomes), *starts.fate.tolist()])
    occurring_ends = [end for end in range(1, outcome_count + 1) if end > len(starts.outcomes) or starts.outcomes[end - 1].occurs]
    distinct, ends = np.unique(entered), np.array([int(Fate.BOUNDED), *occurring_ends])
    counts = [np.count_nonzero((entered == entrance) & (starts.fate == end)) for entrance in distinct for end in ends]
    shaped_counts = np.array(counts, np.int64).reshape(distinct.size, ends.size)
    return ExitMatching(distinct, ends, shaped_counts, starts.outcomes, made_by=starts.made_by)
