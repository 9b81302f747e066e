"""Search for the Lyapunov orbits, the unstable periodic orbits over the open saddles, from which the exits are made.

In a frame that does not rotate, the path of such an orbit across its channel is the exit. In a rotating frame, an orbit is a
closed curve, and the exit is a parabola across the channel just outside the orbit (`exit_lines.line_across`).
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from engine.exits.beyond_exits import find_extent, returning_share
from engine.exits.exit_lines import line_across
from engine.exits.exit_shapes import curve_along, find_reach
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.mirrored_orbits import Images, ImagesDifferError, OrbitSearchError, find_with_images, image_exits, meets_image
from engine.exits.path_crossings import closes_channel, paths_meet
from engine.exits.saddle_orbits.brake_orbits import (
    BrakeOrbit,
    chord_axes,
    continue_in_energy,
    find_directly,
    find_from_both_ends,
    saddle_axes,
)
from engine.exits.saddle_orbits.merged_orbits import axes_between, find_merged_orbits
from engine.exits.saddle_orbits.multiple_shooting import find_brake_orbit, find_saddle_orbit
from engine.foundations.validation import checked_number, checks_types
from engine.foundations.wording import format_point
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.landscape.hill_component import Extent
from engine.systems.merged_channels import MergedExit
from engine.systems.potential import Potential

# Heights above the escape energy at which wells are examined for openings to infinity: powers of these numbers, from the least
# height on, in units of the well.
_HEIGHT_BASES = (4.0, 2.0)
_LEAST_HEIGHT = 1.0 / 16.0

# Time for which orbits are followed beyond the exit of several channels, in units of the well.
_MERGED_FOLLOWED_TIME = 30.0

# Reasons why an exit of several channels is not defined, by rank. Of the reasons of all orbits found, the highest is reported.
_NO_ORBIT, _SHARP_BEND, _RETURNS = range(3)
_REASONS = {
    _NO_ORBIT: "no orbit at rest on both of its outer walls was found with all its saddles between; choose another energy",
    _SHARP_BEND: "the orbit between its outer walls has too sharp a bend for a smooth curve; choose a higher energy",
    _RETURNS: "orbits that leave across the orbit between its outer walls come back; choose another energy",
}


class UndefinedExitsError(ValueError):
    """The exits of a potential are not defined at an energy above the escape energy, for a `reason`."""

    def __init__(self, message: str, reason: str) -> None:
        super().__init__(message, reason)
        self.reason = reason

    def __str__(self) -> str:
        return str(self.args[0])


@checks_types(potential=Potential)
def find_lyapunov_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Return the Lyapunov orbit over each saddle below `energy`.

    In a frame that does not rotate the orbit oscillates between two points at rest. In a rotating frame it is a closed curve
    around the saddle, found by Newton's method and followed from the small oscillations; H is the Jacobi integral.

    Parameters
    ----------
    potential
        Any `Potential`.
    energy
        h, finite, dimensionless; tested up to 0.5 for cases I and II and up to 1.0 for case III.

    Returns
    -------
    The orbits in channel order; empty at or below the escape energy. Above a maximum of V between two channels, the channels form
    one exit with one orbit, from one outer wall to the other.

    Raises
    ------
    ValueError
        If `energy` is not finite, or if the exits are not defined at this energy: a Lyapunov orbit is not found or cannot be
        written as u = f(s) along a line, two exits meet, or channels form one exit all around the well. In a rotating frame also
        if several channels form one exit, or if the parabola outside an orbit does not end on the walls of its channel.

    Examples
    --------
    >>> from escape_explorer import CASES, find_lyapunov_orbits
    >>> [round(orbit.period, 6) for orbit in find_lyapunov_orbits(CASES["I"], 0.19)]
    [4.437671, 4.437671]
    >>> find_lyapunov_orbits(CASES["I"], 0.1)
    ()
    """
    units = potential.units
    orbits = find_orbits_in_well_units(potential.in_well_units, checked_number("energy", energy) / units.energy)
    return tuple(replace(orbit.restored(units), potential=potential) for orbit in orbits)


def find_orbits_in_well_units(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Apply `find_lyapunov_orbits` to a potential in units of its well; errors state the energy in the units of the user."""
    try:
        orbits = _find_orbits(potential, energy)
    except OrbitSearchError as error:
        stated = energy * potential.well.stated_units.energy
        raise UndefinedExitsError(f"energy={stated}: {error} (potential {potential.name})", str(error)) from None
    return tuple(replace(orbit, potential=potential) for orbit in orbits)


def find_known_exits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Apply `find_lyapunov_orbits`, but return no orbits if the exits are not defined at the energy."""
    try:
        return find_lyapunov_orbits(potential, energy)
    except UndefinedExitsError:
        return ()


_Search = Callable[[Potential, float, int], BrakeOrbit | None]
# Functions that find the orbit over a saddle in a frame at rest. If the first one does not find all orbits, the slower ones are
# tried, in turn. If these find orbits of mirror images that differ, only the last one is accurate enough.
_FIRST = (find_directly,)
_SLOWER = (continue_in_energy, find_from_both_ends, find_brake_orbit)
_LAST = (find_brake_orbit,)


def _find_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Return the orbits of a potential in units of its well, if orbits cannot leave for infinity without passing them."""
    orbits = _find_all_orbits(potential, energy)
    well = potential.well
    # Above the escape energy, the energy up to which the well is closed need not be found.
    if not well.escapes_over_saddles or (energy <= well.escape_energy and energy <= well.closed_energy):
        return orbits
    if well.exits_unknown:
        raise OrbitSearchError(f"the exits are not known: {well.exits_unknown}")
    if not potential.channels:
        limit = well.closed_energy * well.stated_units.energy
        shown = f"only up to h = {limit:.6g}; choose a lower energy" if math.isfinite(limit) else "at no energy"
        raise OrbitSearchError(f"there is no exit, and the well is shown to be closed {shown}")
    _check_closed(potential, energy)
    return orbits


def _check_closed(potential: Potential, energy: float) -> None:
    """Raise OrbitSearchError unless orbits cannot leave for infinity without passing the exits at an energy, see `find_extent`.

    A higher energy serves all lower ones. Therefore a few energies are examined first, if the exits are defined there. Each
    potential along a parameter has one energy only.
    """
    height = energy - potential.escape_energy
    for base in _HEIGHT_BASES if height > 0.0 and not potential.lineage.family else ():
        higher = max(_LEAST_HEIGHT, base ** math.ceil(math.log(height, base)))
        if higher > height and _find_extent(potential, potential.escape_energy + higher) is Extent.BOUNDED:
            return
    extent = _find_extent(potential, energy)
    if extent is Extent.UNBOUNDED:
        raise OrbitSearchError("the region of motion leads to infinity beside the exits; choose a lower energy")
    if extent is Extent.UNDECIDED:
        raise OrbitSearchError(
            "it is not decided whether the region of motion leads to infinity beside the exits; choose another energy"
        )


@functools.lru_cache(maxsize=1024)
def _find_extent(potential: Potential, energy: float) -> Extent:
    """Return the extent of the region of motion inside the exits at an energy; undecided if the exits are not defined."""
    try:
        orbits = _find_all_orbits(potential, energy)
    except OrbitSearchError:
        return Extent.UNDECIDED
    return find_extent(potential, energy, orbits)


@functools.lru_cache(maxsize=1024)
def _find_all_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Return the orbits of a potential in units of its well."""
    if potential.rotation:
        _check_separate(potential, energy)
        channels = potential.well.open_channels(energy)
        orbits = tuple(_find_closed_orbit(potential, energy, channel) for channel in channels)
        _check_exits_apart(orbits)
        return orbits
    with suppress(OrbitSearchError):
        return _find_separate_orbits(potential, energy, _FIRST)
    try:
        return _find_separate_orbits(potential, energy, _SLOWER)
    except ImagesDifferError:
        return _find_separate_orbits(potential, energy, _LAST)


def _find_separate_orbits(potential: Potential, energy: float, searches: Sequence[_Search]) -> tuple[LyapunovOrbit, ...]:
    """Find orbits that do not meet, each over a single saddle by the first of the `searches` that succeeds."""
    orbits: dict[int, LyapunovOrbit] = {}
    merged = {exit.channels[0]: exit for exit in potential.well.merged_exits(energy)}
    numbers, images = potential.well.exit_numbers(energy), image_exits(potential, energy)
    find_merged = functools.partial(_find_merged, potential, energy, merged)
    find_single = functools.partial(_find_orbit, potential, energy, searches, images)
    for channel in potential.well.open_channels(energy):
        # A channel may belong to an exit with the number of a lower channel.
        if channel not in orbits and numbers[channel] == channel:
            find = find_merged if channel in merged else find_single
            orbits |= find_with_images(find, channel, images, needs_all=searches is _FIRST)
    others = {channel: exit.channels[1:] for channel, exit in merged.items()}
    separate = tuple(replace(orbits[channel], others=others.get(channel, ())) for channel in sorted(orbits))
    _check_exits_apart(separate)
    return separate


def _check_separate(potential: Potential, energy: float) -> None:
    """Raise an error if several channels form one exit."""
    if merged_exits := potential.well.merged_exits(energy):
        exit_text = _describe_merged_exit(potential, merged_exits[0])
        raise OrbitSearchError(f"{exit_text}, which has no Lyapunov orbit in a rotating frame; choose a lower energy")


def _describe_merged_exit(potential: Potential, merged: MergedExit) -> str:
    """Return which channels form an exit, and above which maximum of V, for messages."""
    # The mergers are sorted by energy.
    lowest = next(merger for merger in potential.well.channel_mergers if set(merger.channels) <= set(merged.channels))
    units = potential.well.stated_units
    position = format_point(lowest.x * units.length, lowest.y * units.length)
    return f"channels {merged.name} are one exit above V = {lowest.energy * units.energy:.6g}, the maximum at {position}"


def _find_merged(potential: Potential, energy: float, exits: Mapping[int, MergedExit], channel: int) -> LyapunovOrbit:
    """Return the orbit between the outer walls of an exit of several channels; `exits` by their lowest channels."""
    merged = exits[channel]
    if merged.closes_ring:
        raise OrbitSearchError(
            f"{_describe_merged_exit(potential, merged)}, and it leads all around the well; choose a lower energy"
        )
    axes, saddle = axes_between(potential, merged.channels), potential.saddles[merged.channels[0] - 1]
    reason = _NO_ORBIT
    for orbit in find_merged_orbits(potential, energy, merged.channels):
        curve = curve_along(axes, saddle, orbit.path)
        if curve is None:
            reason = max(reason, _SHARP_BEND)
            continue
        lyapunov_orbit = _exit_over(potential, energy, channel, orbit, curve)
        if not returning_share(potential, energy, {channel: curve}, channel, _MERGED_FOLLOWED_TIME):
            return lyapunov_orbit
        reason = _RETURNS
    raise OrbitSearchError(f"{_describe_merged_exit(potential, merged)}, and {_REASONS[reason]}")


def _check_exits_apart(orbits: tuple[LyapunovOrbit, ...]) -> None:
    """Raise an error if two exits meet."""
    for first, second in itertools.combinations(orbits, 2):
        if paths_meet(first.exit_path, second.exit_path):
            raise OrbitSearchError(f"the exits of channels {first.channel} and {second.channel} meet; choose a lower energy")


def _find_closed_orbit(potential: Potential, energy: float, channel: int) -> LyapunovOrbit:
    """Return the orbit over a saddle in a rotating frame, with the exit just outside the orbit."""
    orbit = find_saddle_orbit(potential, energy, channel)
    if orbit is None:
        raise OrbitSearchError(f"no Lyapunov orbit was found across channel {channel}; choose another energy")
    curve = line_across(potential, energy, channel, orbit.edge)
    if curve is None:
        raise OrbitSearchError(
            f"the line at the outer edge of the Lyapunov orbit across channel {channel} does not end on its walls; "
            "choose a lower energy"
        )
    x, y = orbit.path[:2].copy()
    return LyapunovOrbit(channel, energy, orbit.period, x, y, curve, orbit.path[2:, 0].copy(), potential=potential)


def _find_orbit(potential: Potential, energy: float, searches: Sequence[_Search], images: Images, channel: int) -> LyapunovOrbit:
    """Return the orbit over a saddle in a frame at rest, found by the first of the searches that succeeds."""
    reason = f"no Lyapunov orbit was found across channel {channel}; choose another energy"
    for search in searches:
        orbit = search(potential, energy, channel)
        if (
            orbit is None
            or not closes_channel(potential, energy, channel, orbit.path)
            or meets_image(orbit.path, channel, images)
        ):
            continue
        axes = saddle_axes(potential, channel) if search in _FIRST else chord_axes(orbit.path)
        curve = curve_along(axes, potential.saddles[channel - 1], orbit.path)
        if curve is not None:
            return _exit_over(potential, energy, channel, orbit, curve)
        reason = f"the Lyapunov orbit across channel {channel} is not a smooth graph; choose another energy"
    raise OrbitSearchError(reason)


def _exit_over(potential: Potential, energy: float, channel: int, orbit: BrakeOrbit, curve: np.ndarray) -> LyapunovOrbit:
    """Return an orbit between two points at rest, with its exit `curve`. The reach is written into `curve`."""
    curve[geometry.REACH] = find_reach(potential, energy, curve)
    x, y = orbit.path
    there_and_back = np.concatenate([np.arange(x.size), np.arange(x.size - 1)[::-1]])
    path = x[there_and_back], y[there_and_back]
    period, inner_states = 2.0 * orbit.half_period, orbit.inner_states
    return LyapunovOrbit(channel, energy, period, *path, curve, inner_states=inner_states, potential=potential)
