"""The layer of the periodic orbits, whose returns are drawn as rings and crosses over other pictures."""

from __future__ import annotations

import numpy as np

from engine import MapSpec, Stability
from engine.jobs.job import Job
from engine.results import PeriodicOrbits
from plots.layers.layer import Count, Layer, Over, Stroke
from plots.pictures.palette import Entry, Mark, Palette
from plots.pictures.periodic_marks import RETURNS, STABILITY_COLOURS, periodic_job
from plots.pictures.setting import Settings

# Largest number of returns.
_MOST_RETURNS = 12
# Radius of a mark as a share of the window, for 1, 2, 3 and more returns: the more returns, the smaller the island.
_RADII = (0.016, 0.013, 0.010, 0.008)
# Corners of a ring.
_CORNERS = 24
# Widths of the lines and of the halo on each side, in pixels.
_WIDTH, _HALO_RIM = 1.6, 1.0


def periodic_strokes(found: PeriodicOrbits) -> list[Stroke]:
    """Return the marks of the returns, those of stable orbits in front."""
    kinds = list(STABILITY_COLOURS)[::-1]
    return [stroke for kind in kinds if (stroke := _stroke(found, kind)) is not None]


def _stroke(found: PeriodicOrbits, stability: Stability) -> Stroke | None:
    """Return the marks of the orbits of one stability; None without any."""
    rows = np.flatnonzero(found.stability == stability)
    if not rows.size:
        return None
    window = found.spec.find_window()
    extents = np.array([high - low for low, high in window.ranges])
    radii = np.array(_RADII)[np.minimum(found.returns[rows], len(_RADII)) - 1]
    draw = _ring if stability is Stability.STABLE else _cross
    marks = zip(found.points[rows], radii[:, None] * extents, strict=True)
    lines = tuple(line for point, radius in marks for line in draw(point, radius))
    return Stroke(lambda palette: STABILITY_COLOURS[stability], lines, _WIDTH, _WIDTH + 2.0 * _HALO_RIM, 1.0)


def _ring(point: np.ndarray, radius: np.ndarray) -> list[np.ndarray]:
    angles = np.linspace(0.0, 2.0 * np.pi, _CORNERS + 1)
    return [point + radius * np.column_stack([np.cos(angles), np.sin(angles)])]


def _cross(point: np.ndarray, radius: np.ndarray) -> list[np.ndarray]:
    return [point + radius * np.array([[-1.0, -sign], [1.0, sign]]) for sign in (1.0, -1.0)]


def _entries(found: PeriodicOrbits, palette: Palette) -> list[Entry]:
    kinds = [kind for kind in STABILITY_COLOURS if np.any(found.stability == kind)]
    return [Entry(f"periodic, {kind.value}", STABILITY_COLOURS[kind], Mark.LINE, group="periodic orbits") for kind in kinds]


def _job(spec: MapSpec, settings: Settings) -> Job[PeriodicOrbits]:
    return periodic_job(spec, settings.get(PERIODIC_ORBITS.name, RETURNS))


def _refusal(spec: MapSpec) -> str:
    if spec.backward:
        return "Periodic orbits are drawn on maps forward in time only."
    if not spec.section.is_drawn_on(spec.plane):
        return f"Periodic orbits are drawn on the slice of the surface of section only; {spec.plane.title} is another slice."
    return ""


PERIODIC_ORBITS = Layer(
    name="periodic",
    title="Periodic orbits",
    help="Largest number of returns of the periodic orbits, on the slice of the section such as x_px; 0 for none.",
    stage="periodic orbits",
    result=PeriodicOrbits,
    job=_job,
    refusal=_refusal,
    count=Count("RETURNS", _MOST_RETURNS),
    over=Over(pictures=("curves", "basins", "times", "crossings", "characters"), legend=_entries, strokes=periodic_strokes),
    has_table=True,
)
"""Centres of islands, and the unstable orbits between them."""
