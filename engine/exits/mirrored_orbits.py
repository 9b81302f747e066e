"""Orbits over saddles that are mirror images of each other: found for some of the saddles, and mirrored to the others."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.path_crossings import paths_meet
from engine.systems.landscape.mirror_images import MIRROR_X, Signs, find_images
from engine.systems.potential import Potential

Images = Mapping[Signs, np.ndarray]
"""For each reflection, the number of the exit that is the mirror image of each channel, (channels + 1,). Entry 0 is 0."""

# Largest distance between an orbit and the mirror image of another if these are the same orbit, in units of the well.
_SAME_ORBIT = 1e-9


class OrbitSearchError(Exception):
    """No Lyapunov orbit was found, or the orbit found cannot be used as an exit."""


class ImagesDifferError(OrbitSearchError):
    """The orbits found over saddles that are mirror images are not mirror images."""


def image_exits(potential: Potential, energy: float) -> Images:
    """Return the exits that are mirror images of each other at an energy."""
    numbers = potential.well.exit_numbers(energy)
    images = {signs: 1 + find_images(potential.saddles, signs) for signs in potential.well.mirrors}
    return {signs: numbers[np.append(0, channels)] for signs, channels in images.items()}


def find_with_images(
    find: Callable[[int], LyapunovOrbit], channel: int, images: Images, *, needs_all: bool
) -> dict[int, LyapunovOrbit]:
    """Return the orbits of a channel and of its mirror images, by number.

    Orbits are exact mirror images under x → −x, because maps compute only one of two such pixels. Under y → −y, orbits are
    searched from the other wall of the channel, which confirms the first orbit. If only one search succeeds, its orbit is
    mirrored, unless `needs_all`.

    Parameters
    ----------
    find
        Returns the orbit of a channel; `OrbitSearchError` without one.
    channel
        The number of an exit.
    images
        The exits that are mirror images of each other.
    needs_all
        Whether all searches must succeed.

    Raises
    ------
    OrbitSearchError
        If no orbit is found, with `needs_all` also if one is not found.
    ImagesDifferError
        If orbits of mirror images, or the two sides of a symmetric orbit, differ.
    """
    found: dict[int, LyapunovOrbit] = {}
    errors = []
    for number in sorted({channel, *(int(exits[channel]) for exits in images.values())}):
        if number in found:
            continue
        try:
            orbit = find(number)
        except OrbitSearchError as error:
            if needs_all:
                raise
            errors.append(error)
            continue
        found[number] = orbit
        if MIRROR_X in images:
            x_image = int(images[MIRROR_X][number])
            found[x_image] = orbit.symmetrized(MIRROR_X) if x_image == number else orbit.mirrored(x_image, MIRROR_X)
    if not found:
        raise errors[0]
    first = next(iter(found.values()))
    for signs, exits in images.items():
        number = int(exits[first.channel])
        image = first.mirrored(number, signs)
        if not _are_same(found.setdefault(number, image), image):
            raise ImagesDifferError(f"no Lyapunov orbit was found across channel {number}; choose another energy")
    return found


def meets_image(path: np.ndarray, channel: int, images: Images) -> bool:
    """Return whether the path (2, n) of an orbit over a saddle meets its mirror image over another saddle."""
    return any(exits[channel] != channel and paths_meet(path.T, path.T * signs) for signs, exits in images.items())


def _are_same(one: LyapunovOrbit, other: LyapunovOrbit) -> bool:
    """Return whether two orbits have the same path, in the same or in the opposite direction."""
    path, other_path = one.half_path, other.half_path
    return bool(min(np.abs(path - other_path).max(), np.abs(path - other_path[::-1]).max()) <= _SAME_ORBIT)
