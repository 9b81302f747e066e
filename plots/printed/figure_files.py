"""Contents of files of figures and movies. The functions import Matplotlib when called, because its import is slow."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from engine import EscapeMap, Potential, Result, Window, compute_statistics
from engine.results import SampledOrbits
from plots.layers.layer import NO_ANALYSES, Analyses
from plots.pictures.orbit_curves import OrbitCurves, initial_state
from plots.pictures.palette import Palette
from plots.pictures.setting import Settings
from plots.pictures.time_scale import TimeScale
from plots.printed.figure_style import FigureFormat, FigureStyle, MovieFormat
from plots.studies.study import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def map_figure_bytes(
    frame: EscapeMap,
    pictures: Sequence[str],
    palette: Palette,
    format: FigureFormat,
    style: FigureStyle,
    *,
    analyses: Analyses = NO_ANALYSES,
    starts: Sequence[tuple[float, float]] = (),
    times: TimeScale | None = None,
) -> bytes:
    """Return the content of a figure file with pictures of a map. The metadata contain the map's provenance.

    For parameters and exceptions, see `plots.printed.map_figure.draw_map_figure` and `plots.printed.figure_axes.save_figure`.
    """
    from plots.printed.map_figure import draw_map_figure

    return _figure_bytes(
        lambda: draw_map_figure(frame, pictures, palette, style, analyses=analyses, starts=starts, times=times),
        format,
        frame.provenance(),
    )


def orbits_figure_bytes(
    potential: Potential,
    orbits: Sequence[OrbitCurves],
    palette: Palette,
    verdicts: Sequence[str],
    format: FigureFormat,
    style: FigureStyle,
) -> bytes:
    """Return the content of a file with the figure of `plots.printed.orbit_figure.draw_orbits_figure`.

    The metadata contain the starts, energies and verdicts.

    Parameters
    ----------
    potential
        The potential of the orbits.
    orbits
        Curves of the orbits, at least one.
    palette, format, style
        As in `map_figure_bytes`.
    verdicts
        A sentence for each orbit.

    Raises
    ------
    ValueError
        If there is no orbit, or not one verdict for each orbit.
    """
    from plots.printed.orbit_figure import draw_orbits_figure

    facts = {"potential": potential.name}
    for number, (curves, verdict) in enumerate(zip(orbits, verdicts, strict=True), 1):
        facts[f"start {number}"] = ", ".join(map(repr, initial_state(curves.orbit)))
        facts |= {f"energy {number}": repr(curves.orbit.energy), f"verdict {number}": verdict}
    return _figure_bytes(lambda: draw_orbits_figure(potential, orbits, palette, verdicts, style), format, facts)


def well_figure_bytes(
    potential: Potential,
    energy: float,
    orbits: Sequence[OrbitCurves],
    palette: Palette,
    format: FigureFormat,
    style: FigureStyle,
) -> bytes:
    """Return the content of a file with the figure of `plots.printed.orbit_figure.draw_well_figure`.

    Parameters
    ----------
    potential
        The potential.
    energy
        The energy h of the zero-velocity curve, dimensionless.
    orbits
        Curves of the orbits to draw; may be empty.
    palette, format, style
        As in `map_figure_bytes`.
    """
    from plots.printed.orbit_figure import draw_well_figure

    facts = {"potential": potential.name, "energy": repr(energy)}
    return _figure_bytes(lambda: draw_well_figure(potential, energy, orbits, palette, style), format, facts)


def statistics_figure_bytes(frame: EscapeMap, box: Window | None, format: FigureFormat, style: FigureStyle) -> bytes:
    """Return the content of a file with the figure of `plots.printed.curve_figures.draw_statistics_figure`.

    `box` is as in `engine.compute_statistics`.
    """
    from plots.printed.curve_figures import draw_statistics_figure

    facts = frame.provenance()
    if box is not None:
        facts["box"] = box
    statistics = compute_statistics(frame, box)
    return _figure_bytes(lambda: draw_statistics_figure(statistics, style), format, facts)


def study_figure_bytes(study: Study[Any], found: Result, settings: Settings, format: FigureFormat, style: FigureStyle) -> bytes:
    """Return the content of a file with the figure of `plots.printed.curve_figures.draw_study_figure`.

    The metadata contain the attributes of the result's dataset.
    """
    from plots.printed.curve_figures import draw_study_figure

    facts = {str(name): value for name, value in found.to_xarray().attrs.items()}
    return _figure_bytes(lambda: draw_study_figure(study, found, style, settings), format, facts)


def ensemble_movie_bytes(
    potential: Potential, orbits: SampledOrbits, palette: Palette, format: MovieFormat, style: FigureStyle
) -> bytes:
    """Return the content of the file of a movie, see `plots.printed.ensemble_movie.make_ensemble_movie`."""
    from plots.printed.ensemble_movie import make_ensemble_movie

    return make_ensemble_movie(potential, orbits, palette, format, style)


def _figure_bytes(draw: Callable[[], Figure], format: FigureFormat, facts: Mapping[str, object]) -> bytes:
    """Draw a figure and return the content of its file. Matplotlib is not thread-safe, so only one thread draws at a time."""
    from plots.printed.figure_axes import RENDER_LOCK, save_figure

    with RENDER_LOCK:
        return save_figure(draw(), format, {name: str(value) for name, value in facts.items()})
