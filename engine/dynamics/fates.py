"""Codes and texts for the outcome of an orbit, and the criterion for chaos."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from engine.taylor.kernels import events

CHAOS_THRESHOLD = 1e-7
"""A bounded orbit is chaotic if its SALI falls to this value or below (Skokos 2001; the criterion of Zotos 2014)."""

MIN_REGULAR_TIME = 1000.0
"""Shortest orbit that can be called regular without a certificate, in units of the well: weak chaos takes this long."""


class Fate(IntEnum):
    """Code of the outcome of an orbit. Codes from 1 are not members; they are the number of the channel it escaped through."""

    BOUNDED = events.BOUNDED
    FORBIDDEN = -1
    OUTSIDE = -2
    NOT_COMPUTED = events.NOT_COMPUTED
    FAILED = events.FAILED


class Regularity(IntEnum):
    """Character of a bounded orbit. ``NOT_APPLICABLE``: it escapes or does not exist; ``NOT_JUDGED``: not computed yet."""

    NOT_APPLICABLE = 0
    REGULAR = 1
    CHAOTIC = 2
    NOT_JUDGED = 3

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


class Trust(IntEnum):
    """Whether the outcome of a pixel is robust against small changes.

    ``NOT_APPLICABLE``: forbidden, outside or failed. ``LIKE_NEIGHBOURS``: not tested because all neighbours have the same
    outcome, and the orbit escapes or has a certificate. ``CONFIRMED``: tested and unchanged. ``DOUBTFUL``: its fate, its number
    of crossings before the escape or its escape time changed, or it is bounded only by chance. ``NOT_TESTED``: not computed yet.
    """

    NOT_APPLICABLE = 0
    LIKE_NEIGHBOURS = 1
    CONFIRMED = 2
    DOUBTFUL = 3
    NOT_TESTED = 4

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


_SENTENCES = {
    Fate.BOUNDED: "Bounded: has not escaped by t_max.",
    Fate.FORBIDDEN: "Forbidden: no orbit of this energy can start here because its kinetic energy would be negative.",
    Fate.OUTSIDE: "Outside: the start lies beyond a Lyapunov orbit.",
    Fate.NOT_COMPUTED: "Not computed yet.",
    Fate.FAILED: "Failed: the integration broke down; please report this start.",
}


def describe_fate(fate: int) -> str:
    """A sentence for a fate code, including channel numbers."""
    return f"Escaped through channel {fate}." if fate >= 1 else _SENTENCES[Fate(fate)]


def is_chaotic(sali: np.ndarray) -> np.ndarray:
    """Whether bounded orbits with these final SALI values (any shape) are chaotic; bool, and True for NaN."""
    return np.logical_not(sali > CHAOS_THRESHOLD)


def judge_regularity(sali: float) -> Regularity:
    """Regular or chaotic, from the final SALI of a bounded orbit (0 to √2)."""
    return Regularity.CHAOTIC if is_chaotic(np.asarray(sali)) else Regularity.REGULAR
