"""The study of the surface of section: the returns of many orbits of one energy to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import MapSpec, Section, compute_returns
from engine.jobs.job import Job
from engine.results import Returns
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
    Section.Y_UP.axes.symbols,
    "Where many orbits of this energy cross the surface of section, up to their exits, each in one of a few colours. A regular "
    "orbit stays on a curve: nested curves are an island, and chains of small islands are resonances. A chaotic orbit fills an "
    "area, or leaves a few points and escapes. Controls, Slice, chooses the section.",
    "Click to follow the orbit from (@x{number}, @y{number})",
    described=Shape.DOTS,
    is_square=True,
)


def _job(subject: Subject, axis: str) -> Job[Returns]:
    section = subject.section
    spec = MapSpec(subject.potential, section.plane, subject.energy, _STARTS, t_max=subject.t_max, section=section)
    return Job(compute_returns, (spec,), (("returns", RETURNS),))


def section_charts(found: Returns, palette: Palette) -> list[Chart]:
    """Return the chart of the points of the orbits, in the window of starts on the section; empty without points."""
    colours = palette.orbits
    series = [
        Series("", colours[number % len(colours)], points[:, 0], points[:, 1], Shape.DOTS)
        for number, points in enumerate(found.points())
    ]
    spec = found.spec
    frame = replace(FRAME, labels=spec.section.axes.symbols)
    limits = spec.find_window().ranges if spec.section.is_drawn_on(spec.plane) else (None, None)
    return [Chart(frame, series, limits)] if series else []


def _changes(subject: Subject, axis: str, found: Returns, x: float, y: float) -> Changes:
    """Return the start at the point nearest to the click, if starts on the section have the coordinates of the chart."""
    section = found.spec.section
    if not section.is_drawn_on(found.spec.plane):
        return {}
    window, points = found.spec.find_window(), np.concatenate(found.points())
    distance = np.hypot((points[:, 0] - x) / window.width, (points[:, 1] - y) / window.height)
    nearest = points[np.argmin(distance)].tolist()
    return {"plane": section.plane, "energy": subject.energy, "start": tuple(nearest)}


def _sentence(found: Returns) -> str:
    can_click = found.complete and bool(found.count.any()) and found.spec.section.is_drawn_on(found.spec.plane)
    return f"{found.describe()}{' Click a point to follow its orbit.' if can_click else ''}"


def _caption(found: Returns) -> str:
    return f"{found.spec.potential.name}: {found.describe()}"


SECTION_STUDY = Study(
    name="section",
    title="Section",
    follows_map=True,
    hint=f"The points at which many orbits cross the surface of section, up to {RETURNS} of each orbit.",
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
