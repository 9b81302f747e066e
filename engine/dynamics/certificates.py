"""Why an orbit is called bounded: followed to the end, or certified early."""

from __future__ import annotations

from enum import IntEnum


class Certificate(IntEnum):
    """What the word bounded rests on, strongest claim about this very orbit first.

    ``NONE`` stands where nothing is called bounded. ``INTEGRATED``: followed to t_max. ``CLOSED``: its energy is below
    every saddle. ``QUASI_PERIODIC``: its weighted averages converge as those of a torus do, and of very few other orbits.
    ``ENCLOSED``: invariant curves of certified orbits part it from every exit; it may be chaotic itself. ``MIRRORED``: the
    mirror image of an orbit certified early.
    """

    NONE = 0
    INTEGRATED = 1
    CLOSED = 2
    QUASI_PERIODIC = 3
    ENCLOSED = 4
    MIRRORED = 5


_SENTENCES = {
    Certificate.NONE: "",
    Certificate.INTEGRATED: "followed to t_max",
    Certificate.CLOSED: "its energy is below every saddle",
    Certificate.QUASI_PERIODIC: "certified: quasi-periodic, as on an invariant torus",
    Certificate.ENCLOSED: "certified: invariant curves part it from every exit",
    Certificate.MIRRORED: "certified: mirror image of a certified orbit",
}


def describe_certificate(certificate: int) -> str:
    """A phrase for a certificate code."""
    return _SENTENCES[Certificate(certificate)]
