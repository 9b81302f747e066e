"""Reasons why an orbit is classified as bounded: it was integrated to t_max, or evidence ended its integration early."""

from __future__ import annotations

from enum import IntEnum


class Evidence(IntEnum):
    """The reason why an orbit is classified as bounded.

    ``NONE``: the orbit is not classified as bounded. ``INTEGRATED``: it was integrated to t_max. ``CLOSED``: its energy is below
    every saddle, which proves that it is bounded. The other members are numerical evidence, not proof, that it never escapes.
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


_PHRASES = {
    Evidence.NONE: "",
    Evidence.INTEGRATED: "integrated to t_max",
    Evidence.CLOSED: "its energy is below every saddle",
    Evidence.QUASI_PERIODIC: "evidence: its averages converge as on an invariant torus",
    Evidence.ENCLOSED: "evidence: invariant curves separate it from every exit",
    Evidence.MIRRORED: "evidence: that of its mirror image",
}


def describe_evidence(evidence: int) -> str:
    """Return the reason for an `Evidence` code as a phrase, empty for ``NONE``."""
    return _PHRASES[Evidence(evidence)]
