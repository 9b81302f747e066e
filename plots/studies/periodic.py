"""The study of periodic orbits: the points at which they return to the surface of section."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import MapSpec, Stability
from engine.jobs.job import Job
from engine.results import PeriodicOrbits
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.palette import Palette
from plots.pictures.periodic_marks import RETURNS, STABILITY_COLOURS, periodic_job
from plots.pictures.setting import NO_SETTINGS, Setting, Settings
from plots.studies.section import FOLLOW_POINT, start_through
from plots.studies.study import Changes, Click, Study, Subject

FRAME = Frame(
    "periodic",
    "Periodic orbits",
    ("", ""),
    "Where periodic orbits return to the surface of section. A ring is a stable orbit, with an island of regular orbits around "
    "it. A cross is an unstable one, near which orbits are chaotic or escape. T is the period, and a the stability "
    'index: an orbit is stable if a is between −1 and 1. On maps along h, the layer "Periodic orbits" draws the families of '
    "all energies.",
    "@note<br>Click to follow the orbit from (@x{number}, @y{number})",
    described=Shape.RINGS,
    aspect=1.0,
)

# What a click on a return does.
_FOLLOW = f"{FOLLOW_POINT} On an unstable one, rounding errors grow until the path leaves it."

UP_TO = Setting(
    name="periodic_returns",
    title="Returns of periodic orbits",
    word="Returns up to",
    choices={str(returns): returns for returns in range(1, RETURNS + 1)},
    default=RETURNS,
    help="Largest number of returns of the periodic orbits that are drawn.",
)
"""Which orbits are drawn."""


def _job(subject: Subject, axis: str) -> Job[PeriodicOrbits]:
    section = subject.section
    plane, energy = section.slice_of_starts, subject.energy
    if not section.is_drawn_on(plane):
        raise ValueError(
            f"Periodic orbits are not searched on {section.place}, whose points are on no slice. Choose y = 0 or x = 0."
        )
    return periodic_job(MapSpec(subject.potential, plane, energy, window=subject.window, t_max=subject.t_max, section=section))


def periodic_charts(found: PeriodicOrbits, palette: Palette, settings: Settings = NO_SETTINGS) -> list[Chart]:
    """Return the chart of the returns of periodic orbits; empty without orbits."""
    is_drawn = found.returns <= UP_TO.value_in(settings)
    if not is_drawn.any():
        return []
    notes = np.array([orbit.describe().removesuffix(".") for orbit in found], object)
    series = []
    for stability, colour in STABILITY_COLOURS.items():
        shown = is_drawn & (found.stability == stability)
        if shown.any():
            x, y = found.points[shown].T
            shape = Shape.RINGS if stability is Stability.STABLE else Shape.CROSSES
            series.append(Series(stability.value, colour, x, y, shape, notes=notes[found.orbit[shown] - 1].tolist()))
    return [Chart(replace(FRAME, labels=found.section.axes.symbols), series, found.spec.find_window().ranges)]


def _changes(subject: Subject, axis: str, found: PeriodicOrbits, click: Click) -> Changes:
    """Return the start of the orbit with the return nearest to the click, at this return."""
    point = found.nearest_point(click.x, click.y)
    return {} if point is None else start_through(found.section, subject.potential, found.states[point], subject.energy)


def _invite(found: PeriodicOrbits) -> str:
    return _FOLLOW if len(found) and found.section.plane is not None else ""


PERIODIC_STUDY = Study(
    name="periodic",
    title="Periodic",
    follows_map=True,
    hint=f"The periodic orbits with up to {RETURNS} returns to the section, and whether they are stable: a few seconds.",
    job=_job,
    sentence=PeriodicOrbits.describe,
    invitation=_invite,
    frames=(FRAME,),
    charts=periodic_charts,
    changes=_changes,
    files="periodic",
    figure="Periodic orbits",
    caption=lambda found: f"{found.spec.potential.name}: {found.describe()}",
    settings=(UP_TO,),
)
"""The centres of islands, and the unstable orbits between them."""
