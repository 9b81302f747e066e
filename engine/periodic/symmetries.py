"""Symmetries of the motion, reflections and reversal of time, and images of states and periodic orbits under them."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from engine.systems.landscape.mirror_images import IDENTITY, MIRROR_BOTH, Signs
from engine.systems.landscape.mirror_symmetry import well_mirrors
from engine.systems.potential import Potential

_MIRROR_NAMES = {(1.0, 1.0): "", (-1.0, 1.0): "x → −x", (1.0, -1.0): "y → −y", (-1.0, -1.0): "rotation by 180°"}


class Symmetry(NamedTuple):
    """A map of orbits onto orbits: a reflection of x and y, and possibly the reversal of time.

    Attributes
    ----------
    signs
        The factors of x and y.
    reverses_time
        Whether time is reversed.
    """

    signs: Signs
    reverses_time: bool

    @property
    def factors(self) -> np.ndarray:
        """(4,) factors of x, y, px and py."""
        sign = -1.0 if self.reverses_time else 1.0
        return np.array([*self.signs, sign * self.signs[0], sign * self.signs[1]])

    @property
    def name(self) -> str:
        """The symmetry in words: "x → −x with reversed time"."""
        mirror = _MIRROR_NAMES[self.signs]
        return f"{mirror} with reversed time".strip() if self.reverses_time and mirror else mirror or "reversed time"


def symmetries_of(potential: Potential) -> tuple[Symmetry, ...]:
    """Return the symmetries of the motion, without the identity.

    A reflection turns the rotation of a frame around, and so does the reversal of time: in a rotating frame, a symmetry has both
    or neither. A rotation by 180° has no influence on the rotation.
    """
    mirrors = (IDENTITY, *well_mirrors(potential.form, 0.0, potential.ends))
    pairs = (Symmetry(*pair) for pair in itertools.product(mirrors, (False, True)))
    turned = {IDENTITY: False, MIRROR_BOTH: False}
    found = (each for each in pairs if not potential.rotation or each.reverses_time == turned.get(each.signs, True))
    return tuple(each for each in found if each != Symmetry(IDENTITY, False))
