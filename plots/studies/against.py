"""The study of the measures of the maps against the energy or a parameter."""

from __future__ import annotations

from engine import SweepSpec, compute_sweep
from engine.foundations.wording import format_number
from engine.jobs.job import Job
from engine.measures.table import curve_names
from engine.results import Sweep
from engine.sweeps.sweep_job import sweep_job
from plots.studies.axes import changes_at, energy_and_parameters, parameter_axis, spaced_values, swept_slice
from plots.studies.study import Study, Subject
from plots.studies.sweep_charts import CURVE_PANELS, SHARES, measure_frame, sweep_charts

SWEPT_VALUES = 25
"""Number of evenly spaced values of the energy or the parameter."""

REFINED_VALUES = 8
"""Number of further values, placed where the shares change most."""

# Columns and rows of each map of a sweep.
_RESOLUTION = (112, 112)


def _job(subject: Subject, axis: str) -> Job[Sweep]:
    along = parameter_axis(subject, axis)
    spec = SweepSpec(
        subject.potential,
        swept_slice(subject),
        spaced_values(subject, axis, SWEPT_VALUES),
        _RESOLUTION,
        t_max=subject.t_max,
        measures=curve_names(),
        along=along,
        energy=None if along is None else subject.energy,
        refine=REFINED_VALUES,
        section=subject.section,
    )
    return sweep_job(spec)


def sweep_progress(curves: Sweep) -> float:
    """Return the share of the values of a sweep that have been measured."""
    return float(curves.values.size / curves.dataset.attrs["count"])


def _sentence(curves: Sweep) -> str:
    """Describe how many values have been measured, and where."""
    request = curves.dataset.attrs
    energy = f" at h = {format_number(request['energy'], 6)}" if "energy" in request else ""
    values = f"values of {curves.symbol} on {request['plane']}{energy}"
    if curves.complete:
        return f"{request['count']} {values}."
    return f"{curves.values.size} of {request['count']} {values}"


def sweep_caption(curves: Sweep) -> str:
    """Return the title of the figure of a sweep: its request."""
    request = curves.dataset.attrs
    starts = " × ".join(str(side) for side in request["resolution"])
    return f"{request['potential']}, {request['plane']}, {starts} starts, t_max = {request['t_max']:g}"


AGAINST = Study(
    name="energies",
    title="Against",
    button="Compute the curves",
    hint=f"The shares and each measure at {SWEPT_VALUES + REFINED_VALUES} values, closer together where the shares change: "
    "a minute or more.",
    axes=energy_and_parameters,
    job=_job,
    function=compute_sweep,
    progress=sweep_progress,
    sentence=_sentence,
    invitation=lambda curves: "Click a curve to open the map there.",
    frames=(measure_frame(SHARES), *map(measure_frame, CURVE_PANELS)),
    charts=lambda curves, palette, settings: sweep_charts(curves, palette),
    changes=lambda subject, axis, curves, click: changes_at(subject, axis, curves.values, click.x),
    files="curves",
    figure="Curves against energy",
    caption=sweep_caption,
)
"""The shares of the outcomes and the other measures of the maps."""
