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
    'area, or leaves a few points and escapes. Controls, "Axes …", chooses the section.',
    "Click to follow the orbit from (@x{number}, @y{number})",
    described=Shape.DOTS,
    is_square=True,
)


def _job(subject: Subject, axis: str) -> Job[Returns]:
    section = subject.section
    spec = MapSpec(subject.potential, section.slice_of_starts, subject.energy, _STARTS, t_max=subject.t_max, section=section)
    return Job(compute_returns, (spec,), (("returns", RETURNS),))


def section_charts(found: Returns, palette: Palette) -> list[Chart]:
    """Return the chart of the points of the orbits, in the window of starts on the section; empty without points."""
    colours = palette.orbits
    series = [
        Series("", colours[number % len(colours)], points[:, 0], points[:, 1], Shape.DOTS)
        for number, points in enumerate(found.points())
    ]
    spec = found.spec
    text = FRAME.text if spec.section.plane is not None else ""
    frame = replace(FRAME, labels=spec.section.axes.symbols, text=text)
    limits = spec.find_window().ranges if spec.section.is_drawn_on(spec.plane) else (None, None)
    return [Chart(frame, series, limits)] if series else []


def _changes(subject: Subject, axis: str, found: Returns, x: float, y: float) -> Changes:
    """Return the start of the return nearest to the click, on a slice on the section, if there is one."""
    section, states = found.spec.section, found.states[np.isfinite(found.time)]
    points = section.axes.points(states)
    extents = np.ptp(points, axis=0)
    steps = (points - [x, y]) / np.where(extents > 0.0, extents, 1.0)
    start = section.find_start(subject.potential, states[np.argmin(np.hypot(*steps.T))])
    if start is None:
        return {}
    plane, place = start
    return {"plane": plane, "energy": subject.energy, "start": place}


def _sentence(found: Returns) -> str:
    can_click = found.complete and bool(found.count.any()) and found.spec.section.plane is not None
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
