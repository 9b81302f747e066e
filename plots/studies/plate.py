"""The study of a plate: small maps at several energies and several values of a parameter, with a measure of each."""

from __future__ import annotations

from engine import MapSpec, SweepSpec, compute_sweep
from engine.jobs.job import Job
from engine.measures.table import curve_names
from engine.results import Sweep
from engine.sweeps.sweep_job import sweep_job
from plots.pictures.charts import Chart, Frame
from plots.pictures.palette import Palette
from plots.pictures.setting import Settings
from plots.studies.against import sweep_caption, sweep_progress
from plots.studies.axes import ENERGY, parameter_axis, spaced_values, swept_slice, system_changes
from plots.studies.map_tiles import BESIDE, OPEN_MAP, TILES_ASPECT, TileGrid
from plots.studies.study import Changes, Click, Study, Subject

PLATE_GRID = TileGrid(columns=5, rows=5)
"""Energies from left to right, values of the parameter from below."""

# Columns and rows of each map.
_RESOLUTION = (80, 80)

PLATE = Frame(
    "plate",
    "Basins against h and a parameter",
    ("", ""),
    "The basins of escape at several energies, from left to right, and at several values of a parameter, from below, in the same "
    "window of the plane, with a measure of each map. Click a map to open it.",
    text="Click to open the map of @name",
    aspect=TILES_ASPECT,
    has_tiles=True,
)


def _job(subject: Subject, axis: str) -> Job[Sweep]:
    along = parameter_axis(subject, axis) if axis else None
    if along is None:
        raise ValueError("This system has no parameter. A typed formula has one for each letter.")
    plane, energies = swept_slice(subject), spaced_values(subject, ENERGY, PLATE_GRID.columns)
    spec = SweepSpec(
        subject.potential,
        plane,
        (energies, spaced_values(subject, axis, PLATE_GRID.rows)),
        _RESOLUTION,
        # Maps along a parameter have no default window.
        MapSpec(subject.potential, plane, energies[-1], _RESOLUTION).find_window(),
        t_max=subject.t_max,
        measures=("maps", *curve_names(slow=False)),
        along=(ENERGY, along),
        section=subject.section,
    )
    return sweep_job(spec)


def plate_charts(found: Sweep, palette: Palette, settings: Settings) -> list[Chart]:
    """Return the maps of a sweep over energies and a parameter as tiles; empty before the first map."""
    places = _places(found)
    axes = found.dataset.attrs["requested"], found[found.axes[1]].tolist()
    return [PLATE_GRID.chart(PLATE, found, places, palette, settings, axes)] if places else []


def _places(found: Sweep) -> dict[int, tuple[int, ...]]:
    """Return the indices of each map by its place, whose column is that of its energy among the requested ones."""
    requested = found.dataset.attrs["requested"]
    places: dict[int, tuple[int, ...]] = {}
    for k, h in enumerate(found.values.tolist()):
        for row in range(found[found.axes[1]].size):
            places[(PLATE_GRID.rows - 1 - row) * PLATE_GRID.columns + requested.index(h)] = k, row
    return places


def _changes(subject: Subject, axis: str, found: Sweep, click: Click) -> Changes:
    """Return the changes that open the map of a click; none between the maps and for maps that are not computed."""
    index = PLATE_GRID.map_at(click, _places(found))
    if index is None:
        return {}
    return system_changes(subject, axis, float(found[axis][index[1]]), float(found.values[index[0]]))


PLATE_STUDY = Study(
    name="plate",
    title="Plate",
    tab="nine_energies",
    button="Compute a plate",
    hint="Small maps at five energies and five values of a parameter: half a minute or more.",
    axes=lambda system: (*system.letters, *system.entry.adjustable),
    job=_job,
    function=compute_sweep,
    progress=sweep_progress,
    sentence=Sweep.describe,
    invitation=lambda found: OPEN_MAP,
    frames=(PLATE,),
    charts=plate_charts,
    changes=_changes,
    files="plate",
    figure="Maps against h and a parameter",
    caption=sweep_caption,
    settings=(BESIDE,),
)
"""How the basins depend on the energy and on a parameter together."""
