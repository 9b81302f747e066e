"""Stable manifolds of the Lyapunov orbits on a section, by default y = 0, py > 0: the boundaries between exit basins.

Orbits that tend to the Lyapunov orbit over an exit form a tube, its stable manifold. Orbits inside the tube leave through that
exit, orbits outside it turn back. Backward in time the tube enters the well and intersects the section repeatedly; the successive
intersections are called its images. As the kinetic energy is even in the momenta, an orbit backward in time is an orbit with
reversed momenta of the same system, or, if its frame rotates, of the system whose frame rotates the other way. The tube backward
in time is thus the unstable manifold in that system with reversed momenta. The code integrates this unstable manifold forward
from near the Lyapunov orbit; each passage of the section in the opposite direction gives a point of the stable manifold, if its
momenta are reversed.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.foundations.arrays import ReadOnlyArrays
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.result import Result
from engine.foundations.validation import checked_count, checked_number, checks_types
from engine.foundations.wording import format_whole
from engine.slices.axes import STATE
from engine.slices.default_window import default_window
from engine.slices.sections.linear_section import section_of_coordinate
from engine.slices.sections.section import Crossing, Section, axes_of_slice
from engine.slices.sections.section_text import checked_section, section_of_file
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow, checked_window
from engine.systems.potential import Potential
from engine.systems.well_units import LENGTH, MOMENTUM
from engine.trajectories.smooth_curves import PointSpacing, refine_passages, split_curve
from engine.trajectories.unstable_manifold import UnstableManifold

if TYPE_CHECKING:
    import xarray as xr

MOST_IMAGES = 6
"""Largest number of images. The arcs of later images would be too fine and too many to plot."""

ORBITS_PER_IMAGE = 20_000
"""Largest number of orbits per channel and image, about 0.3 s of work. Arcs that these orbits do not resolve are left out."""

# Factors of x, y, px and py that reverse the momenta.
_REVERSED = np.array([1.0, 1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False)
class ManifoldArc(ReadOnlyArrays):
    """A connected piece of one stable manifold on the section.

    Attributes
    ----------
    channel
        Exit channel of the Lyapunov orbit, from 1.
    image
        1 for the tube's first intersection with the section backward in time, 2 for the next, …
    x, ordinate
        (n,) places on the slice of the section, by default x and px, in order along the curve; dimensionless, read-only; n ≥ 2.
        The last point of a closed curve equals the first.
    """

    channel: int
    image: int
    x: np.ndarray = field(metadata=LENGTH)
    ordinate: np.ndarray = field(metadata=MOMENTUM)


@dataclass(frozen=True, eq=False, repr=False)
class StableManifolds(Result):
    """Intersections of the stable manifolds of all Lyapunov orbits of one energy with a section.

    Attributes
    ----------
    potential, energy
        The `Potential` and h, dimensionless.
    arcs
        The arcs, sorted by channel, then by image.
    images
        Number of images computed for each tube.
    truncated
        Whether an arc is truncated, because it winds around another arc infinitely often, ends at a body, or is too fine to be
        resolved.
    section
        The surface of section; the arcs are curves on the slice `section.plane`.
    """

    potential: Potential
    energy: float
    arcs: tuple[ManifoldArc, ...]
    images: int
    truncated: bool
    section: Section = Section.Y_UP
    row_dimension: ClassVar = "point"
    held_as: ClassVar = {"arcs": "arc", "section": "section"}

    def provenance(self) -> dict[str, Any]:
        """Return the potential, the energy, the slice, the section, the integrator and the version."""
        return self.potential.describe_run(
            energy=self.energy, plane=self.section.slice_of_starts.title, section=self.section.text
        )

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return all points, with the number of their arc from 1, its channel and its image."""
        labels = [(number, arc.channel, arc.image) for number, arc in enumerate(self.arcs, 1)]
        sizes = [arc.x.size for arc in self.arcs]
        points = (np.concatenate([np.empty(0), *(getattr(arc, name) for arc in self.arcs)]) for name in ("x", "ordinate"))
        codes = np.repeat(np.array(labels, int).reshape(-1, 3), sizes, axis=0).T
        return dict(zip(self._column_names(self.section), (*codes, *points), strict=True))

    @staticmethod
    def _column_names(section: Section) -> tuple[str, ...]:
        return ("arc", "channel", "image", *section.slice_of_starts.axis_names)

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the arcs, from the variables that hold the result of `columns`."""
        section = section_of_file(dataset.attrs)
        numbers, *columns = (dataset[name].values for name in cls._column_names(section))
        starts = np.flatnonzero(np.diff(numbers, prepend=0))
        parts = [np.split(column, starts[1:]) for column in columns] if starts.size else [[]] * 4
        arcs = (ManifoldArc(int(channel[0]), int(image[0]), x, y) for channel, image, x, y in zip(*parts, strict=True))
        return {"arcs": tuple(arcs), "section": section}

    def describe(self) -> str:
        """Return the numbers of arcs and points in one sentence."""
        image_numbers = sorted({arc.image for arc in self.arcs})
        label = "images" if len(image_numbers) > 1 else "image"
        image_text = f"{label} {', '.join(map(str, image_numbers))}" if image_numbers else "no image"
        points = format_whole(sum(arc.x.size for arc in self.arcs))
        note = ", some of them truncated" if self.truncated else ""
        return f"Stable manifolds of the Lyapunov orbits, {image_text}: {len(self.arcs)} arcs of {points} points{note}."

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return sum(arc.x.nbytes + arc.ordinate.nbytes for arc in self.arcs)


@checks_types(potential=Potential, execution=Execution)
def find_stable_manifolds(
    potential: Potential,
    energy: float,
    *,
    images: int = 3,
    window: GivenWindow | None = None,
    section: Section | str = Section.Y_UP,
    execution: Execution = DEFAULT_EXECUTION,
) -> StableManifolds:
    """Find the curves on a section that separate orbits leaving through a channel from orbits turning back before it.

    On one side of an arc of image n, orbits leave through its channel after exactly n − 1 crossings of the section, the start not
    counted. On the other side they turn back before that exit, and leave later or never. Where the Lyapunov orbit itself crosses
    the section (channel 1 of Case II; L1 and L2 on y = 0), orbits that stay near it for longer cross it more often. In this case,
    images are numbered along the curve, which starts at the Lyapunov orbit's own point, and the number of crossings is not fixed.

    The frame may rotate. The tube is then computed in the frame that rotates at −Ω, whose orbits are those of this frame backward
    in time, with reversed momenta.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        h, finite, dimensionless.
    images
        Number of successive intersections of each tube with the section, 1 to 6.
    window
        Part of the slice to resolve, given as in `MapSpec`; None for the whole plane. In a smaller window points are closer, as
        far as the number of orbits allows. Curves beyond the window are left out.
    section
        The surface of section: a `Section` or text, see `read_section`. It must be one of positions, such as "x = 0, px > 0" or
        "angle = 30° up", crossed in one direction. The arcs are curves on the slice `section.plane`, by default (x, px).
    execution
        How the computation runs.

    Returns
    -------
    The `StableManifolds`, which have no arcs at or below the escape energy. An arc ends where the tube, backward in time, leaves
    through an exit. Near this end the arc winds infinitely often around an arc of another manifold, and is truncated after the
    first few turns. An arc also ends where the tube, backward in time, meets a body: no orbit comes from there. Points lie on the
    manifold to 1e-10.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When `energy` is not finite or too high for unstable Lyapunov orbits, `images` is out of range, no exit is over a saddle
        because orbits escape at a circle, `section` is not legal, or a Lyapunov orbit crosses it more than once in a period or
        has a multiplier above 1e9.

    Notes
    -----
    Tubes and their role in escapes: Contopoulos 1990, Astron. Astrophys. 231, 41; Koon, Lo, Marsden & Ross 2000, Chaos 10, 427.

    Examples
    --------
    >>> from escape_explorer import CASES, find_stable_manifolds
    >>> manifolds = find_stable_manifolds(CASES["I"], 0.19, images=1)
    >>> [(arc.channel, arc.image) for arc in manifolds.arcs]
    [(1, 1), (2, 1)]
    """
    if not potential.escapes_over_saddles:
        raise ValueError(
            f"potential={potential.name}: its orbits escape at a circle; stable manifolds belong to exits over saddles"
        )
    images = checked_count("images", images, 1, MOST_IMAGES)
    energy, section = checked_number("energy", energy), _checked_section(section)
    plane_window = default_window(potential, section.slice_of_starts, energy)
    zoom_window = None if window is None else checked_window(window)
    units = potential.units
    factors = 1.0 / units.length, 1.0 / units.momentum
    scaled_zoom = None if zoom_window is None else zoom_window.scaled(*factors)
    spacing = PointSpacing.for_window(plane_window.scaled(*factors), scaled_zoom)
    # A given window need not be symmetric, so all channels are computed in it.
    uses_mirror = potential.in_well_units.well.mirror_in_x and section.is_mirrored and window is None
    tubes = _Tubes(section.in_well_units(units), images, spacing, execution)
    arcs, truncated = _find_all_arcs(potential.reversed_in_time.in_well_units, energy / units.energy, tubes, uses_mirror)
    return StableManifolds(potential, energy, tuple(map(units.restore, arcs)), images, truncated, section)


def section_of_starts(plane: Slice, section: Section) -> Section | None:
    """Return the section on which the starts of a slice are, as `find_stable_manifolds` takes it; None if there is none.

    This is `section`, if the starts are on it, or a section of x or of y.
    """
    return section if section.plane == plane and _is_crossed_by_tubes(section) else section_of_coordinate(plane)


def _is_crossed_by_tubes(section: Section) -> bool:
    return section.is_of_positions and section.direction is not Crossing.BOTH


def _checked_section(value: Section | str) -> Section:
    section = checked_section(value)
    if not _is_crossed_by_tubes(section):
        raise ValueError(
            f"section={section.text!r}: must be a section of positions that is crossed in one direction, such as 'x = 0 up'"
        )
    return section


def _find_all_arcs(potential: Potential, energy: float, tubes: _Tubes, uses_mirror: bool) -> tuple[list[ManifoldArc], bool]:
    """Return the arcs of all channels in units of the well, and whether any arc is truncated.

    With `uses_mirror`, the arcs of the second of two mirror channels are copied from the first.
    """
    orbits = {orbit.channel: orbit for orbit in find_orbits_in_well_units(potential, energy)}
    mirror_channels = potential.well.mirror_numbers(energy) if uses_mirror else np.arange(potential.channels + 1)
    computed_channels = [channel for channel in orbits if channel <= mirror_channels[channel]]
    # Each thread mostly waits for the tiles of its channel.
    with ThreadPoolExecutor(max(len(computed_channels), 1)) as threads:
        results = list(threads.map(lambda channel: tubes.find_arcs(orbits[channel]), computed_channels))
    truncated = any(is_truncated for _, is_truncated in results)
    arcs_by_channel = {channel: arcs for channel, (arcs, _) in zip(computed_channels, results, strict=True)}
    return [arc for channel in orbits for arc in _arcs_of(channel, arcs_by_channel, int(mirror_channels[channel]))], truncated


def _arcs_of(channel: int, arcs_by_channel: dict[int, list[ManifoldArc]], mirror_channel: int) -> list[ManifoldArc]:
    """Return the arcs of a channel; if they are not computed, those of its mirror channel, mirrored."""
    if channel in arcs_by_channel:
        return arcs_by_channel[channel]
    # The section is its own image under x → −x, which maps (x, px) to (−x, −px).
    return [ManifoldArc(channel, arc.image, -arc.x, -arc.ordinate) for arc in arcs_by_channel[mirror_channel]]


@dataclass(frozen=True, eq=False)
class _Tubes:
    """The computation of the arcs of a channel, in units of the well.

    Attributes
    ----------
    section, images, execution
        As in `find_stable_manifolds`.
    spacing
        The spacing of the points of an arc.
    """

    section: Section
    images: int
    spacing: PointSpacing
    execution: Execution

    def find_arcs(self, orbit: LyapunovOrbit) -> tuple[list[ManifoldArc], bool]:
        """Return the arcs of one channel, and whether any arc is truncated."""
        tube = self._tube(orbit)
        count = tube.near_passages + self.images
        plane = self.section.slice_of_starts
        axes, solved = axes_of_slice(plane), STATE.index(plane.decided)

        def find_places(phases: np.ndarray) -> np.ndarray:
            passages = tube.find_passages(phases, count, self.execution)
            states = passages[..., :4] * _REVERSED
            # On an oblique line, a few of these states are no starts of the slice, because the momentum has the other sign.
            states[states[..., solved] * plane.sign < 0.0] = np.nan
            return np.concatenate([axes.points(states), passages[..., 4:]], axis=-1)

        passages = refine_passages(find_places, count, self.spacing, self.images * ORBITS_PER_IMAGE)
        arcs = []
        is_truncated = False
        for image in range(1, self.images + 1):
            # The passages near the Lyapunov orbit join end to end and belong to image 1.
            first = 0 if image == 1 else tube.near_passages + image - 1
            curve = np.concatenate([passages[:, k] for k in range(first, tube.near_passages + image)])
            pieces = split_curve(curve, self.spacing, closed=tube.near_passages == 0)
            is_truncated |= not (len(pieces) == 1 and np.isfinite(curve).all())
            lines = (line for piece in pieces for line in self.spacing.thin(piece))
            arcs += [ManifoldArc(orbit.channel, image, *line.T.copy()) for line in lines]
        return arcs, is_truncated

    def _tube(self, orbit: LyapunovOrbit) -> UnstableManifold:
        """Return the unstable manifold, which is the stable manifold with reversed momenta; it crosses the section backward."""
        section = replace(self.section, direction=self.section.direction.reversed)
        try:
            return UnstableManifold.from_orbit(orbit, section.numbers)
        except ValueError as error:
            raise ValueError(f"energy={orbit.energy * orbit.potential.well.stated_units.energy}: {error}") from None
