"""The share of chaotic orbits among the bounded orbits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.foundations.result import Result
from engine.foundations.validation import short_repr
from engine.foundations.wording import format_share, format_share_range
from engine.measures.basins.starts import wilson_interval
from engine.propagation.fates import JUDGEMENTS, Regularity


@dataclass(frozen=True)
class ChaoticShare(Result):
    """The share of chaotic orbits among the judged bounded orbits.

    Attributes
    ----------
    chaotic, judged
        Number of chaotic orbits, and number of all judged bounded orbits, which include the chaotic ones.
    share
        Share of the chaotic orbits among the judged orbits; NaN if no orbit is judged.
    low, high
        Ends of the 95 % Wilson interval of the share, for independent random starts; NaN if no orbit is judged.
    """

    chaotic: int
    judged: int
    share: float
    low: float
    high: float

    def describe(self) -> str:
        """Return the share with its interval in a sentence."""
        if not self.judged:
            return "No bounded orbit was judged."
        interval = format_share_range(self.low, self.high, 1)
        return f"Of the {self.judged} bounded orbits judged, {format_share(self.share)} are chaotic ({interval})."


def compute_chaotic_share(character: Any) -> ChaoticShare:
    """Count the chaotic orbits among the bounded orbits.

    Orbits without a sign of chaos until t_max count as not chaotic, as in Zotos (2014). Undecided orbits do not count.

    Parameters
    ----------
    character
        A `RegularityMap`, or `Regularity` codes of any shape.

    Returns
    -------
    The `ChaoticShare`.

    Raises
    ------
    ValueError
        If `character` is not an array of codes.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_chaotic_share, compute_map, compute_regularity
    >>> escapes = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (20, 20), t_max=2e3))
    >>> share = compute_chaotic_share(compute_regularity(escapes))
    >>> round(share.low, 2), round(share.share, 2), round(share.high, 2)
    (0.17, 0.23, 0.3)
    """
    # A `RegularityMap` has the codes as its attribute `character`.
    codes = np.asarray(getattr(character, "character", character))
    if codes.dtype.kind not in "iu":
        raise ValueError(f"character={short_repr(character)}: must be a RegularityMap, or an array of codes of Regularity")
    chaotic_count = int(np.count_nonzero(codes == Regularity.CHAOTIC))
    judged_count = int(np.count_nonzero(np.isin(codes, JUDGEMENTS)))
    if not judged_count:
        return ChaoticShare(0, 0, np.nan, np.nan, np.nan)
    low, high = wilson_interval(chaotic_count, judged_count)
    return ChaoticShare(chaotic_count, judged_count, chaotic_count / judged_count, float(low), float(high))
