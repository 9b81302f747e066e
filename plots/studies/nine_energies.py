"""The study of the maps at nine energies: small pictures of the basins, with a measure of each, and their escapes."""

from __future__ import annotations

from engine import Plane, Section, SweepSpec, compute_statistics, compute_sweep
from engine.foundations.wording import format_number
from engine.jobs.job import Job
from engine.measures.table import curve_names
from engine.results import Sweep
from engine.sweeps.sweep_job import sweep_job
from engine.systems.catalogue.published_fits import PAPER_FITS, PaperFits
from plots.pictures.charts import Chart, Frame
from plots.pictures.palette import Palette
from plots.pictures.setting import Settings
from plots.studies.against import sweep_caption, sweep_progress
from plots.studies.axes import ENERGY, changes_at, spaced_values, swept_slice
from plots.studies.escape_charts import ESCAPES, ESCAPES_BY_CROSSINGS, PROBABILITIES_BY_ENERGY, crossing_charts, escapes_chart
from plots.studies.map_tiles import BESIDE, OPEN_MAP, TILES_ASPECT, TileGrid
from plots.studies.study import Changes, Click, Study, Subject

ENERGIES = 9
"""Number of maps."""

_GRID = TileGrid(columns=3, rows=3)
# Columns and rows of each map.
_RESOLUTION = (150, 150)

TILES = Frame(
    "plates",
    "Basins at nine energies",
    ("", ""),
    "The basins of escape at nine energies, in the same window of the plane, and a measure of each map. In the cases of Zotos "
    "(2014) the energies are those of the maps of the paper. Click a map to open it.",
    text="Click to open the map of @name",
    aspect=TILES_ASPECT,
    has_tiles=True,
)


def _job(subject: Subject, axis: str) -> Job[Sweep]:
    spec = SweepSpec(
        subject.potential,
        swept_slice(subject),
        _energies(subject),
        _RESOLUTION,
        t_max=subject.t_max,
        measures=("maps", *curve_names(slow=False)),
        section=subject.section,
    )
    return sweep_job(spec)


def _energies(subject: Subject) -> tuple[float, ...]:
    """Return the energies that the system's range marks if they are nine, otherwise evenly spaced energies."""
    marked = subject.energies.marked
    return marked if len(marked) == ENERGIES else spaced_values(subject, ENERGY, ENERGIES)


def nine_energies_charts(found: Sweep, palette: Palette, settings: Settings) -> list[Chart]:
    """Return the maps of a sweep over nine energies as tiles, and the charts of their escapes; empty before the first map."""
    if not found.values.size:
        return []
    by_energy = {float(h): compute_statistics(found.dataset.isel(h=k)) for k, h in enumerate(found.values)}
    tiles = _GRID.chart(TILES, found, _places(found), palette, settings)
    return [tiles, escapes_chart(by_energy, _fits(found)), *crossing_charts(by_energy)]


def _places(found: Sweep) -> dict[int, tuple[int, ...]]:
    """Return the index of each map by its place, which is that of its energy among the requested ones."""
    requested = found.dataset.attrs["requested"]
    return {requested.index(h): (k,) for k, h in enumerate(found.values.tolist())}


def _fits(found: Sweep) -> PaperFits | None:
    """Return the fits published for the starts of a sweep; None if there are none."""
    request = found.dataset.attrs
    is_of_paper = request["axes"] == Plane.X_PX.key and request["section"] == Section.Y_UP.text
    return PAPER_FITS.get(request["potential"]) if is_of_paper else None


def _changes(subject: Subject, axis: str, found: Sweep, click: Click) -> Changes:
    """Return the changes that open the map of a click, or of an energy on the axis of energies; none for another click."""
    if click.chart == ESCAPES.name:
        return changes_at(subject, ENERGY, found.values, click.x)
    if click.chart != TILES.name:
        return {}
    index = _GRID.map_at(click, _places(found))
    return {} if index is None else {"energy": float(found.values[index]), "plane": swept_slice(subject), "window": None}


def _sentence(found: Sweep) -> str:
    """Describe how many maps there are, and their common window."""
    request = found.dataset.attrs
    x_low, x_high, low, high = (format_number(edge, 4) for edge in request["window"])
    maps = f"maps on {request['plane']}, {x_low} to {x_high} × {low} to {high}"
    if found.complete:
        return f"{found.values.size} {maps}."
    return f"{found.values.size} of {request['count']} {maps}"


NINE_ENERGIES = Study(
    name="nine_energies",
    title="Nine maps",
    button="Compute nine maps",
    hint="Small maps at nine energies, and how many starts escape, directly and after each number of crossings: a minute.",
    job=_job,
    function=compute_sweep,
    progress=sweep_progress,
    sentence=_sentence,
    invitation=lambda found: OPEN_MAP,
    frames=(TILES, ESCAPES, ESCAPES_BY_CROSSINGS, PROBABILITIES_BY_ENERGY),
    charts=nine_energies_charts,
    changes=_changes,
    files="nine_energies",
    figure="Maps at nine energies",
    caption=sweep_caption,
    settings=(BESIDE,),
)
"""The maps of the paper as small multiples."""
