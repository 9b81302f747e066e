"""What became of an orbit, in codes for arrays and in words for people; and what makes a bounded one chaotic."""

from __future__ import annotations

from enum import IntEnum

from engine.taylor.kernels import events

CHAOS_THRESHOLD = 1e-7
"""A bounded orbit is chaotic when its SALI has fallen to this or below (Skokos 2001; the paper's criterion)."""


class Fate(IntEnum):
    """Code of an outcome. A code of 1 or more, which is no member, is the number of the channel the orbit left by."""

    BOUNDED = events.BOUNDED
    FORBIDDEN = -1
    OUTSIDE = -2
    NOT_COMPUTED = events.NOT_COMPUTED
    FAILED = events.FAILED


class Regularity(IntEnum):
    """Character of a bounded orbit; ``NO_QUESTION`` for one that escapes or does not exist, ``NOT_JUDGED`` until it is known."""

    NO_QUESTION = 0
    REGULAR = 1
    CHAOTIC = 2
    NOT_JUDGED = 3

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


class Trust(IntEnum):
    """Whether the answer of a pixel survives.

    ``NO_QUESTION`` for one that is forbidden, outside or failed. ``LIKE_NEIGHBOURS``: its neighbours say the same, so that it was
    not tested. ``CONFIRMED``: tested, and nothing changed. ``DOUBTFUL``: its fate, or its crossings before the escape, changed.
    ``NOT_TESTED`` until it is known.
    """

    NO_QUESTION = 0
    LIKE_NEIGHBOURS = 1
    CONFIRMED = 2
    DOUBTFUL = 3
    NOT_TESTED = 4

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


_SENTENCES = {
    Fate.BOUNDED: "Bounded: has not left by t_max.",
    Fate.FORBIDDEN: "Forbidden: no orbit of this energy can start here, its kinetic energy would be negative.",
    Fate.OUTSIDE: "Outside: the start already lies beyond a Lyapunov orbit.",
    Fate.NOT_COMPUTED: "Not decided yet.",
    Fate.FAILED: "Failed: the integration broke down here; please report this start.",
}


def describe_fate(fate: int) -> str:
    """A sentence for a fate code; channels by their number."""
    return f"Escaped through channel {fate}." if fate >= 1 else _SENTENCES[Fate(fate)]


def judge_regularity(sali: float) -> Regularity:
    """Regular or chaotic, from the SALI a bounded orbit ends with (0 to √2)."""
    return Regularity.CHAOTIC if sali <= CHAOS_THRESHOLD else Regularity.REGULAR
