"""Why an orbit is classified as bounded: integrated to t_max, or on evidence that ends its integration early."""

from __future__ import annotations

from enum import IntEnum


class Certificate(IntEnum):
    """The reason why an orbit is classified as bounded.

    ``NONE``: not classified as bounded. ``INTEGRATED``: integrated to t_max. ``CLOSED``: its energy is below every saddle, which
    proves it. The others are numerical evidence that the orbit never escapes, and no proof.
    ``QUASI_PERIODIC``: its weighted Birkhoff averages converge as on an invariant torus, which is very rare for other orbits.
    ``ENCLOSED``: invariant curves of certified orbits separate it from every exit; it may itself be chaotic. ``MIRRORED``: the
    mirror image of an orbit that was certified early.
    """

    NONE = 0
    INTEGRATED = 1
    CLOSED = 2
    QUASI_PERIODIC = 3
    ENCLOSED = 4
    MIRRORED = 5


_PHRASES = {
    Certificate.NONE: "",
    Certificate.INTEGRATED: "integrated to t_max",
    Certificate.CLOSED: "its energy is below every saddle",
    Certificate.QUASI_PERIODIC: "evidence: its averages converge as on an invariant torus",
    Certificate.ENCLOSED: "evidence: invariant curves separate it from every exit",
    Certificate.MIRRORED: "evidence: that of its mirror image",
}


def describe_certificate(certificate: int) -> str:
    """A phrase for a `Certificate` code."""
    return _PHRASES[Certificate(certificate)]
