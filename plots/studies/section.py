"""The study of the surface of section: the returns of many orbits of one energy to y = 0 upward."""

from __future__ import annotations

import numpy as np

from engine import MapSpec, compute_returns
from engine.jobs.job import Job
from engine.results import Returns
from engine.slices.planes import SECTION
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.palette import Palette
from plots.studies.study import Changes, Study, Subject

RETURNS = 100
"""Number of returns of each orbit."""

# Columns and rows of the starts.
_STARTS = (13, 13)

FRAME = Frame(
    "section",
    "Surface of section",
    SECTION.axis_symbols,
    "Where many orbits of this energy cross y = 0 upward, up to their exits, each in one of a few colours. A regular orbit stays "
    "on a curve: nested curves are an island, and chains of small islands are resonances. A chaotic orbit fills an area, or "
    "leaves a few points and escapes.",
    "Click to follow the orbit from (@x{number}, @y{number})",
    described=Shape.DOTS,
    is_square=True,
)


def _job(subject: Subject, axis: str) -> Job[Returns]:
    spec = MapSpec(subject.potential, SECTION, subject.energy, _STARTS, t_max=subject.t_max)
    return Job(compute_returns, (spec,), (("returns", RETURNS),))


def section_charts(found: Returns, palette: Palette) -> list[Chart]:
    """Return the chart of the points of the orbits, in the window of their starts; empty without points."""
    colours = palette.orbits
    series = [
        Series("", colours[number % len(colours)], points[:, 0], points[:, 1], Shape.DOTS)
        for number, points in enumerate(found.points())
    ]
    window = found.spec.find_window()
    return [Chart(FRAME, series, window.ranges)] if series else []


def _changes(subject: Subject, axis: str, found: Returns, x: float, y: float) -> Changes:
    """Return the start at the point nearest to the click, on the slice and at the energy of the section."""
    window, points = found.spec.find_window(), np.concatenate(found.points())
    distance = np.hypot((points[:, 0] - x) / window.width, (points[:, 1] - y) / window.height)
    nearest_x, nearest_px = points[np.argmin(distance)].tolist()
    return {"plane": SECTION, "energy": subject.energy, "start": (nearest_x, nearest_px)}


def _sentence(found: Returns) -> str:
    can_click = found.complete and bool(found.count.any())
    return f"{found.describe()}{' Click a point to follow its orbit.' if can_click else ''}"


def _caption(found: Returns) -> str:
    return f"{found.spec.potential.name}: {found.describe()}"


SECTION_STUDY = Study(
    name="section",
    title="Section",
    follows_map=True,
    hint=f"The points at which many orbits cross y = 0 upward, up to {RETURNS} of each orbit.",
    job=_job,
    progress=lambda found: 1.0 if found.complete else 0.0,
    sentence=_sentence,
    frames=(FRAME,),
    charts=section_charts,
    changes=_changes,
    files="section",
    figure="Surface of section",
    caption=_caption,
)
"""Islands of regular orbits, resonances and the chaotic sea."""
