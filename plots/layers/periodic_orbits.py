"""The layer of the periodic orbits: their returns as rings and crosses, or along h their families as curves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine import MapSpec, Stability
from engine.jobs.job import Job
from engine.periodic.symmetric.reversals import find_reversal
from engine.results import PeriodicOrbits, SymmetricFamilies
from plots.layers.layer import Count, Layer, Over, Stroke
from plots.pictures.palette import Entry, Mark, Palette
from plots.pictures.periodic_marks import RETURNS, STABILITY_COLOURS, families_job, periodic_job
from plots.pictures.setting import Settings

# Largest number of returns.
_MOST_RETURNS = 12
# Radius of a mark as a share of the window, for 1, 2, 3 and more returns: the more returns, the smaller the island.
_RADII = (0.016, 0.013, 0.010, 0.008)
# Corners of a ring.
_CORNERS = 24
# Widths of the lines of marks, of curves of stable orbits, of other curves, and of the halo on each side, in pixels.
_MARK, _THICK, _THIN, _HALO_RIM = 1.6, 2.8, 1.2, 0.8

type _Found = PeriodicOrbits | SymmetricFamilies


def periodic_strokes(found: _Found) -> list[Stroke]:
    """Return the marks of the returns, or the curves of families, those of stable orbits in front."""
    kinds = reversed(_kinds(found))
    return [_curves(found, kind) if isinstance(found, SymmetricFamilies) else _marks(found, kind) for kind in kinds]


def _kinds(found: _Found) -> list[Stability]:
    """Return the stabilities that occur, in the order of legends."""
    return [kind for kind in STABILITY_COLOURS if np.any(found.stability == kind)]


def _stroke(stability: Stability, lines: tuple[np.ndarray, ...], width: float) -> Stroke:
    return Stroke(lambda palette: STABILITY_COLOURS[stability], lines, width, width + 2.0 * _HALO_RIM, 1.0)


def _curves(found: SymmetricFamilies, stability: Stability) -> Stroke:
    """Return the parts of curves with orbits of one stability."""
    lines = tuple(line for kind, line in _parts(found) if kind is stability)
    return _stroke(stability, lines, _THICK if stability is Stability.STABLE else _THIN)


def _parts(found: SymmetricFamilies) -> Iterator[tuple[Stability, np.ndarray]]:
    """Yield the parts of curves between changes of stability, which are drawn in the middle between two points."""
    begins = np.flatnonzero(np.diff(found.curve)) + 1
    for points, kinds in zip(np.split(found.points, begins), np.split(found.stability, begins), strict=True):
        changes = np.flatnonzero(kinds[1:] != kinds[:-1]) + 1
        middles = 0.5 * (points[changes - 1] + points[changes])
        # Each middle ends one part and begins the next one.
        extended = np.insert(points, np.repeat(changes, 2), np.repeat(middles, 2, axis=0), axis=0)
        parts = np.split(extended, changes + 2 * np.arange(len(changes)) + 1)
        yield from zip(kinds[np.append(0, changes)], parts, strict=True)


def _marks(found: PeriodicOrbits, stability: Stability) -> Stroke:
    """Return the marks of the orbits of one stability."""
    rows = np.flatnonzero(found.stability == stability)
    extents = np.array([high - low for low, high in found.spec.find_window().ranges])
    radii = np.array(_RADII)[np.minimum(found.returns[rows], len(_RADII)) - 1]
    draw = _ring if stability is Stability.STABLE else _cross
    marks = zip(found.points[rows], radii[:, None] * extents, strict=True)
    return _stroke(stability, tuple(line for point, radius in marks for line in draw(point, radius)), _MARK)


def _ring(point: np.ndarray, radius: np.ndarray) -> list[np.ndarray]:
    angles = np.linspace(0.0, 2.0 * np.pi, _CORNERS + 1)
    return [point + radius * np.column_stack([np.cos(angles), np.sin(angles)])]


def _cross(point: np.ndarray, radius: np.ndarray) -> list[np.ndarray]:
    return [point + radius * np.array([[-1.0, -sign], [1.0, sign]]) for sign in (1.0, -1.0)]


def _entries(found: _Found, palette: Palette) -> list[Entry]:
    return [
        Entry(f"periodic, {kind.value}", STABILITY_COLOURS[kind], Mark.LINE, group="periodic orbits") for kind in _kinds(found)
    ]


def _job(spec: MapSpec, settings: Settings) -> Job[_Found]:
    job = periodic_job if spec.plane.energy_axis is None else families_job
    return job(spec, settings.get(PERIODIC_ORBITS.name, RETURNS))


def _refusal(spec: MapSpec) -> str:
    if spec.backward:
        return "Periodic orbits are drawn on maps forward in time only."
    if spec.plane.energy_axis is not None and find_reversal(spec) is None:
        return (
            "On slices along h, periodic orbits are drawn if all starts are on the section and unchanged by a symmetry with "
            f"reversed time, as on (x, h) if V does not depend on the sign of y; {spec.plane.title} is not such a slice."
        )
    if spec.plane.energy_axis is None and not spec.section.is_drawn_on(spec.plane):
        return f"Periodic orbits are drawn on the slice of the surface of section only; {spec.plane.title} is another slice."
    return ""


PERIODIC_ORBITS: Layer[_Found] = Layer(
    name="periodic",
    title="Periodic orbits",
    help="Largest number of returns of the periodic orbits, on the slice of the section such as x_px, or of their families, on "
    "slices along the energy such as x_h; 0 for none.",
    stage="periodic orbits",
    result=PeriodicOrbits | SymmetricFamilies,
    job=_job,
    refusal=_refusal,
    count=Count("RETURNS", _MOST_RETURNS),
    over=Over(pictures=("curves", "basins", "times", "crossings", "characters"), legend=_entries, strokes=periodic_strokes),
    has_table=True,
)
"""Centres of islands, and the unstable orbits between them."""
