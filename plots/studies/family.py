"""The study of the family of the periodic orbit nearest to the chosen orbit, against the energy."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby

import numpy as np

from engine import OrbitFamily, PeriodicOrbit, SpecialKind, Stability, continue_family, find_periodic_orbit
from engine.foundations.wording import format_number
from engine.jobs.job import Job, Queue
from engine.results import SpecialPoint
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.palette import THRESHOLD, Palette
from plots.pictures.periodic_marks import SPECIAL, STABILITY_COLOURS
from plots.pictures.setting import NO_SETTINGS, Settings
from plots.studies.axes import ENERGY
from plots.studies.section import start_through
from plots.studies.study import Changes, Study, Subject

# The range of the stability index in its chart.
_INDEX_LIMITS = (-2.5, 2.5)
# Decimals of returns in their chart.
_RETURN_DECIMALS = 12
# Digits of energies in the sentence, and largest number of special points in it.
_DIGITS, _MOST_NAMED = 8, 6

_HOW = "Thick lines are stable orbits, points are folds, bifurcations and resonances. "
_TEXT = "@note<br>Click to open this energy"


def _frame(name: str, title: str, label: str, text: str) -> Frame:
    """Return the frame of a chart against the energy."""
    return Frame(f"family_{name}", title, (ENERGY, label), _HOW + text, _TEXT, Shape.RINGS)


_RETURNS = _frame("returns", "Returns against h", "", "Where the orbits of the family return to the section.")
_INDEX = _frame(
    "index",
    "Stability index a",
    "a",
    "The orbits are stable while a is between −1 and 1. At 1 families meet or fold back, at −1 the period doubles, and at the "
    "resonances between them chains of islands are born.",
)
_PERIOD = _frame("period", "Period T", "T", "The time after which an orbit repeats itself.")
_ACTION = _frame("action", "Action J", "J", "The integral of the momentum along the orbit; its slope is T.")


def nearest_orbit_job(subject: Subject) -> Job[PeriodicOrbit]:
    """Return the job that finds the periodic orbit nearest to the chosen orbit; ValueError without one."""
    if subject.state is None:
        raise ValueError("Choose an orbit first: the periodic orbit nearest to it is searched for.")
    options = ("t_max", subject.t_max), ("section", subject.section)
    return Job(find_periodic_orbit, (subject.potential, subject.state), options, Queue.LONG_CALL)


def _job(subject: Subject, axis: str) -> Job[OrbitFamily]:
    near = nearest_orbit_job(subject)
    energy = float(subject.potential.energy(np.array(subject.state)))
    bounds = min(subject.energies.low, energy), max(subject.energies.high, energy)
    return Job(continue_family, (near, bounds), queue=Queue.LONG_CALL)


def family_charts(family: OrbitFamily, palette: Palette, settings: Settings = NO_SETTINGS) -> list[Chart]:
    """Return the charts of the returns, the stability index, the period and the action against the energy.

    Empty for a family with one member only.
    """
    if len(family) < 2:
        return []
    # Without rounding errors, which would fill the chart of returns that are all 0.
    returns = np.round(family.points, _RETURN_DECIMALS)
    axis = int(np.argmax(np.ptp(returns, axis=(0, 1))))
    curves = [one for k in range(family.returns) for one in _curves(family, returns[:, k, axis], labelled=k == 0)]
    frame = replace(_RETURNS, labels=(ENERGY, family.section.axes.symbols[axis]))
    bounds = np.array([family.energy.min(), family.energy.max()])
    levels = [Series("", THRESHOLD, bounds, np.full(2, level), Shape.DASHED) for level in (-1.0, 1.0)]
    index = [*_curves(family, family.stability_index), *_special(family, family.stability_index), *levels]
    return [
        Chart(frame, [*curves, *_special(family, returns[:, 0, axis], "special points")]),
        Chart(_INDEX, index, (None, _INDEX_LIMITS)),
        *(
            Chart(frame, [*_curves(family, values), *_special(family, values)])
            for frame, values in ((_PERIOD, family.period), (_ACTION, family.action))
        ),
    ]


def _curves(family: OrbitFamily, values: np.ndarray, *, labelled: bool = False) -> list[Series]:
    """Return the curve of values against the energy: thick where the orbits are stable."""
    middles = 0.5 * (family.stability_index[1:] + family.stability_index[:-1])
    kinds = [Stability.of(index) for index in middles.tolist()]
    series: list[Series] = []
    begin = 0
    for kind, group in groupby(kinds):
        end = begin + len(list(group))
        known = {one.label for one in series}
        label = kind.value if labelled and kind.value not in known else ""
        shape = Shape.THICK if kind is Stability.STABLE else Shape.LINE
        rows = slice(begin, end + 1)
        series.append(Series(label, STABILITY_COLOURS[kind], family.energy[rows], values[rows], shape))
        begin = end
    return series


def _special(family: OrbitFamily, values: np.ndarray, label: str = "") -> list[Series]:
    """Return the special points of a family on the curve of values."""
    if not family.special:
        return []
    rows = np.array([point.member for point in family.special])
    notes = [_name(point) for point in family.special]
    return [Series(label, SPECIAL, family.energy[rows], values[rows], Shape.RINGS, notes=notes)]


def _changes(subject: Subject, axis: str, family: OrbitFamily, x: float, y: float) -> Changes:
    """Return the energy of the member nearest to the click, and the start of the first member of this energy."""
    member = family[int(np.argmin(np.abs(family.energy - x)))]
    return {"energy": member.energy, **start_through(family.section, subject.potential, member.state, member.energy)}


def _sentence(family: OrbitFamily) -> str:
    named = [_name(point) for point in family.special if point.kind is not SpecialKind.RESONANCE]
    more = f" and {len(named) - _MOST_NAMED} more" if len(named) > _MOST_NAMED else ""
    special = f" {', '.join(named[:_MOST_NAMED]).capitalize()}{more}." if named else ""
    if not family.complete:
        return f"{family.describe()}{special}"
    ends = f" Lower end: {family.ends[0]}. Upper end: {family.ends[1]}."
    return f"{family.describe()}{special}{ends}{' Click a curve to open its energy.' if len(family) > 1 else ''}"


def _name(point: SpecialPoint) -> str:
    return f"{point.name} at h = {format_number(point.energy, _DIGITS)}"


FAMILY_STUDY = Study(
    name="family",
    title="Family",
    tab="periodic",
    needs_orbit=True,
    button="Follow the family",
    hint="The family of the periodic orbit nearest to the chosen orbit, against h, with its special points: a few seconds.",
    axes=lambda system: (ENERGY,),
    job=_job,
    progress=lambda family: 1.0 if family.complete else 0.0,
    sentence=_sentence,
    frames=(_RETURNS, _INDEX, _PERIOD, _ACTION),
    charts=family_charts,
    changes=_changes,
    files="family",
    figure="Family of periodic orbits",
    caption=lambda family: f"{family.potential.name}: {family.describe()}",
)
"""How a periodic orbit changes with the energy: where its island is born, divides and vanishes."""
