"""The study of the surface of section: the returns of many orbits of one energy to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import Fate, MapSpec, Potential, Section, compute_returns
from engine.jobs.job import Job
from engine.results import OrbitReturns, Returns
from plots.pictures.charts import Chart, Frame, Limits, Series, Shape
from plots.pictures.palette import Palette, value_colours
from plots.pictures.setting import NO_SETTINGS, Setting, Settings
from plots.studies.study import Changes, Click, Study, Subject

RETURNS = 100
"""Number of returns of each orbit."""

# Columns and rows of the starts.
_STARTS = (13, 13)

FRAME = Frame(
    "section",
    "Surface of section",
    Section.Y_UP.axes.symbols,
    "Where many orbits of this energy cross the surface of section, up to their exits. Their colours tell the orbits apart, or "
    "show how the orbits end, or how close together the points are. A regular orbit stays on a curve: nested curves are an "
    "island, and chains of small islands are resonances. A chaotic orbit fills an area, or leaves a few points and escapes. "
    'Controls, "Axes …", chooses the section.',
    "Click to follow the orbit from (@x{number}, @y{number})",
    described=Shape.DOTS,
    aspect=1.0,
)


COLOURS = Setting(
    name="section_colours",
    title="Colours of the section",
    word="By",
    choices={choice: choice for choice in ("orbit", "fate", "density")},
    default="orbit",
    help="Colours of the points of a section.",
)
"""What the colour of a point says: which orbit it belongs to, how its orbit ends, or how many points are near it."""

DENSITIES = (1, 2, 4, 8, 16, 32)
"""Lower ends of the classes of the number of points in a cell."""

CELLS = 80
"""Cells along each side of the chart, in which points are counted."""


def _job(subject: Subject, axis: str) -> Job[Returns]:
    section = subject.section
    spec = MapSpec(
        subject.potential, section.slice_of_starts, subject.energy, _STARTS, subject.window, t_max=subject.t_max, section=section
    )
    return Job(compute_returns, (spec,), (("returns", RETURNS),))


def section_charts(found: Returns | OrbitReturns, palette: Palette, settings: Settings = NO_SETTINGS) -> list[Chart]:
    """Return the chart of the points of the orbits, in the window of starts on the section; empty without points."""
    if not found.count.any():
        return []
    text = FRAME.text if found.section.plane is not None else ""
    frame = replace(FRAME, labels=found.section.axes.symbols, text=text)
    limits: tuple[Limits | None, Limits | None] = (None, None)
    if isinstance(found, Returns) and found.section.is_drawn_on(found.spec.plane):
        limits = found.spec.find_window().ranges
    choice = COLOURS.value_in(settings)
    if choice == "orbit":
        return [Chart(frame, _by_orbit(found, palette), limits)]
    if choice == "fate":
        return [Chart(frame, _by_fate(found, palette), limits)]
    chart = Chart(frame, [_dots(np.concatenate(found.points()), "")], limits)
    return [replace(chart, series=_by_density(chart))]


def _dots(points: np.ndarray, colour: str, label: str = "") -> Series:
    return Series(label, colour, points[:, 0], points[:, 1], Shape.DOTS)


def _by_orbit(found: Returns | OrbitReturns, palette: Palette) -> list[Series]:
    colours = palette.orbits
    return [_dots(points, colours[number % len(colours)]) for number, points in enumerate(found.points())]


def _by_fate(found: Returns | OrbitReturns, palette: Palette) -> list[Series]:
    """Return the points of the orbits that stay, behind those of the orbits that end at each outcome."""
    fates = found.fates_of_points
    # An orbit with all returns has not ended.
    fates = np.where(fates == Fate.NOT_COMPUTED, Fate.BOUNDED, fates)
    series = []
    for fate in np.unique(fates):
        entry = palette.entry(int(fate), found.outcomes)
        label = "not escaped" if fate == Fate.BOUNDED else entry.label
        points = np.concatenate([each for each, own in zip(found.points(), fates, strict=True) if own == fate])
        series.append(_dots(points, entry.colour, label))
    return series


def _by_density(chart: Chart) -> list[Series]:
    """Return the points of a chart by the number of points in their cells, the densest in front."""
    (all_points,) = chart.series
    points = np.column_stack([all_points.x, all_points.y])
    low, high = np.transpose(chart.axis_limits)
    cells = np.floor((points - low) / (high - low) * CELLS)
    _, cell, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    classes = np.searchsorted(DENSITIES, counts[cell], side="right") - 1
    colours = density_colours()
    return [_dots(points[classes == k], colours[k], _density_label(k)) for k in np.unique(classes)]


def density_colours() -> tuple[str, ...]:
    """Return the colours of the classes of `DENSITIES`."""
    return value_colours(len(DENSITIES))


FOLLOW_POINT = "Click a point to follow its orbit."
"""What a click on a point of a section does."""


def _density_label(k: int) -> str:
    """Return the range of a class of `DENSITIES`. The first label also says what is counted."""
    low, high = DENSITIES[k], (*DENSITIES[1:], None)[k]
    if high is None:
        return f"≥ {low}"
    return "1 point in a cell" if k == 0 else f"{low}–{high - 1}"


def _changes(subject: Subject, axis: str, found: Returns, click: Click) -> Changes:
    """Return the start of the return nearest to the click, on a slice on the section, if there is one."""
    section, states = found.spec.section, found.states[np.isfinite(found.time)]
    points = section.axes.points(states)
    extents = np.ptp(points, axis=0)
    steps = (points - [click.x, click.y]) / np.where(extents > 0.0, extents, 1.0)
    return start_through(section, subject.potential, states[np.argmin(np.hypot(*steps.T))], subject.energy)


def start_through(section: Section, potential: Potential, state: np.ndarray, energy: float) -> Changes:
    """Return the changes of a view that start the orbit of a state, (4,); none if it has another energy or is on no slice."""
    start = section.find_start(potential, state, energy)
    if start is None:
        return {}
    plane, place = start
    return {"plane": plane, "energy": energy, "start": place}


def _invite(found: Returns) -> str:
    can_click = bool(found.count.any()) and found.spec.section.plane is not None
    return FOLLOW_POINT if can_click else ""


SECTION_STUDY = Study(
    name="section",
    title="Section",
    follows_map=True,
    hint=f"The points at which many orbits cross the surface of section, up to {RETURNS} of each orbit.",
    job=_job,
    sentence=Returns.describe,
    invitation=_invite,
    frames=(FRAME,),
    charts=section_charts,
    changes=_changes,
    files="section",
    figure="Surface of section",
    caption=lambda found: f"{found.spec.potential.name}: {found.describe()}",
    settings=(COLOURS,),
)
"""Islands of regular orbits, resonances and the chaotic sea."""
