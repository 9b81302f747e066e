"""Codes and texts for the outcome of an orbit and for the reason why it is called bounded, and the criterion for chaos."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from engine.foundations.result import RecordedResult
from engine.foundations.wording import name_code
from engine.integrator.kernels import events
from engine.systems.outcomes import Exit, Outcome, write_outcomes

if TYPE_CHECKING:
    import xarray as xr

CHAOS_THRESHOLD = 1e-7
"""A bounded orbit is chaotic if its SALI falls to this value or below (Skokos 2001; the criterion of Zotos 2014)."""

MIN_REGULAR_TIME = 1000.0
"""Shortest integration time, in units of the well, after which a bounded orbit without signs of chaos may be called so.

Weak chaos takes about this long to appear.
"""


class Fate(IntEnum):
    """Code of the fate of an orbit. Codes k ≥ 1 are not members: the orbit ended at ``potential.outcomes[k - 1]``."""

    BOUNDED = events.BOUNDED
    FORBIDDEN = events.FORBIDDEN
    OUTSIDE = events.OUTSIDE
    NOT_COMPUTED = events.NOT_COMPUTED
    FAILED = events.FAILED


class Evidence(IntEnum):
    """The reason why an orbit is classified as bounded.

    ``NONE``: the orbit is not classified as bounded. ``INTEGRATED``: it was integrated to t_max. ``CLOSED``: its well is
    closed at its energy, which proves that it is bounded. The other members are numerical evidence, not proof, that it never
    escapes.
    ``QUASI_PERIODIC``: its weighted Birkhoff averages converge as on an invariant torus, which is very rare for other orbits.
    ``ENCLOSED``: invariant curves of quasi-periodic orbits separate it from every exit; the orbit itself may be chaotic.
    ``MIRRORED``: it is the mirror image of an orbit that is bounded on evidence.
    """

    NONE = 0
    INTEGRATED = 1
    CLOSED = 2
    QUASI_PERIODIC = 3
    ENCLOSED = 4
    MIRRORED = 5


class Regularity(IntEnum):
    """Character of a bounded orbit.

    ``NOT_APPLICABLE``: the orbit escapes or does not exist. ``REGULAR``: averages agree as on a torus. ``CHAOTIC``: SALI fell to
    1e-7 or below. ``NO_SIGN_OF_CHAOS``: neither happened until t_max; the orbit may be weakly chaotic. ``NOT_JUDGED``: not
    computed yet. ``UNDECIDED``: rounding carried the orbit out of the well, or its energy was not conserved.
    """

    NOT_APPLICABLE = 0
    REGULAR = 1
    CHAOTIC = 2
    NO_SIGN_OF_CHAOS = 3
    NOT_JUDGED = 4
    UNDECIDED = 5

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


JUDGEMENTS = (Regularity.REGULAR, Regularity.CHAOTIC, Regularity.NO_SIGN_OF_CHAOS)
"""Codes of bounded orbits that are judged."""

_SENTENCES = {
    Fate.BOUNDED: "Bounded: has not escaped by t_max.",
    Fate.FORBIDDEN: "Forbidden: no orbit of this energy can start here because its kinetic energy would be negative.",
    Fate.OUTSIDE: "Outside: the start lies beyond an exit.",
    Fate.NOT_COMPUTED: "Not computed yet.",
    Fate.FAILED: "Unresolved: the steps became too short, as near a singularity of V or on the way to infinity in a finite time.",
}

_EVIDENCE_PHRASES = {
    Evidence.NONE: "",
    Evidence.INTEGRATED: "integrated to t_max",
    Evidence.CLOSED: "its well is closed at this energy",
    Evidence.QUASI_PERIODIC: "evidence: its averages converge as on an invariant torus",
    Evidence.ENCLOSED: "evidence: invariant curves separate it from every exit",
    Evidence.MIRRORED: "evidence: that of its mirror image",
}

UNRESOLVED = "unresolved"
"""Name of `Fate.FAILED` in texts."""


def outcome_of(fate: int, outcomes: Sequence[Outcome] = ()) -> Outcome:
    """Return the outcome of a fate of 1 or more; without known outcomes, as in files of older versions, a channel."""
    return outcomes[fate - 1] if fate <= len(outcomes) else Exit.outcome(fate)


def name_fate(fate: int, outcomes: Sequence[Outcome] = ()) -> str:
    """Return the name of a fate in a word or two, such as "channel 1" or "bounded"."""
    if fate >= 1:
        return outcome_of(fate, outcomes).label
    return UNRESOLVED if fate == Fate.FAILED else name_code(Fate, fate)


def describe_fate(fate: int, outcomes: Sequence[Outcome] = ()) -> str:
    """Describe a fate in a sentence.

    Parameters
    ----------
    fate
        A `Fate`, or the number of an outcome.
    outcomes
        The outcomes of the potential, `Potential.outcomes`; if they are not known, fates of 1 or more are channels.
    """
    return outcome_of(fate, outcomes).sentence if fate >= 1 else _SENTENCES[Fate(fate)]


def describe_evidence(evidence: int) -> str:
    """Return the reason for an `Evidence` code as a phrase, empty for ``NONE``."""
    return _EVIDENCE_PHRASES[Evidence(evidence)]


def renumber(fates: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Return fates of any shape with each outcome k ≥ 1 replaced by ``numbers[k]``, (outcomes + 1,); other codes stay."""
    return np.where(fates > 0, numbers[np.maximum(fates, 0)], fates)


class OrbitResult(RecordedResult):
    """Base of results on orbits, with the outcomes of their potential."""

    outcomes: tuple[Outcome, ...]
    held_as: ClassVar[dict[str, str]] = {"outcomes": "outcomes"}

    @property
    def fate_labels(self) -> Sequence[str]:
        """Labels of the fates 1, 2, …"""
        return [outcome.label for outcome in self.outcomes]

    def to_xarray(self) -> xr.Dataset:
        """Return the dataset of a result, with the outcomes as an attribute."""
        return super().to_xarray().assign_attrs(outcomes=write_outcomes(self.outcomes))


def is_chaotic(sali: np.ndarray | float) -> np.ndarray:
    """Return whether bounded orbits with these final SALI values (any shape) are chaotic; False for NaN."""
    return np.asarray(sali <= CHAOS_THRESHOLD)
