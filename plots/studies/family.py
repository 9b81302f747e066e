"""The study of the family of the periodic orbit nearest to the chosen orbit, against the energy or a parameter."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

import numpy as np

from engine import OrbitFamily, PeriodicOrbit, SpecialKind, Stability, continue_family, find_periodic_orbit
from engine.foundations.wording import format_number
from engine.jobs.job import Job, Queue
from engine.results import SpecialPoint
from plots.pictures.charts import Chart, Frame, Limits, Series, Shape
from plots.pictures.palette import THRESHOLD, Palette
from plots.pictures.periodic_marks import SPECIAL, STABILITY_COLOURS
from plots.pictures.setting import NO_SETTINGS, Settings
from plots.studies.axes import ENERGY, energy_and_parameters, usual_range, value_on
from plots.studies.section import start_through
from plots.studies.study import Changes, Click, Study, Subject

# The range of the stability index in its chart.
_INDEX_LIMITS = (-2.5, 2.5)
# Decimals of returns in their chart.
_RETURN_DECIMALS = 12
# Digits of energies in the sentence, and largest number of special points in it.
_DIGITS, _MOST_NAMED = 8, 6

_HOW = "Thick lines are stable orbits, points are folds, bifurcations and resonances. "
_TEXT = "@note<br>Click to open this member"


def _frame(name: str, title: str, label: str, text: str) -> Frame:
    """Return the frame of a chart; the label of x is that of a family."""
    return Frame(f"family_{name}", title, ("", label), _HOW + text, _TEXT, Shape.RINGS)


_RETURNS = _frame("returns", "Returns", "", "Where the orbits of the family return to the section.")
_INDEX = _frame(
    "index",
    "Stability index a",
    "a",
    "The orbits are stable while a is between −1 and 1. At 1 families meet or fold back, at −1 the period doubles, and at the "
    "resonances between them chains of islands are born.",
)
_PERIOD = _frame("period", "Period T", "T", "The time after which an orbit repeats itself.")
_ACTION = _frame("action", "Action J", "J", "The integral of the momentum along the orbit; against h its slope is T.")


def nearest_orbit_job(subject: Subject) -> Job[PeriodicOrbit]:
    """Return the job that finds the periodic orbit nearest to the chosen orbit; ValueError without one."""
    if subject.state is None:
        raise ValueError("Choose an orbit first: the periodic orbit nearest to it is searched for.")
    options = ("t_max", subject.t_max), ("section", subject.section)
    return Job(find_periodic_orbit, (subject.potential, subject.state), options, Queue.LONG_CALL)


def _job(subject: Subject, axis: str) -> Job[OrbitFamily]:
    near = nearest_orbit_job(subject)
    value = value_on(axis, subject.system, float(subject.potential.energy(np.array(subject.state))))
    low, high = usual_range(subject, axis)
    bounds = min(low, value), max(high, value)
    return Job(continue_family, (near, bounds), (("along", axis),), queue=Queue.LONG_CALL)


class _Curves(NamedTuple):
    """The values of one chart against what changes along the family.

    Attributes
    ----------
    frame
        The frame of the chart.
    values
        (members, n) the values of n curves at each member.
    limits
        The limits of the axis of the values; None to fit it to them.
    """

    frame: Frame
    values: np.ndarray
    limits: Limits | None = None

    @property
    def height(self) -> float:
        """The height of the chart in the units of its values."""
        low, high = self.limits or (float(self.values.min()), float(self.values.max()))
        return high - low or 1.0


def _curves_of(family: OrbitFamily) -> list[_Curves]:
    """Return the curves of all charts. Those of the returns are the coordinate that changes most."""
    # Without rounding errors, which would fill the chart of returns that are all 0.
    returns = np.round(family.points, _RETURN_DECIMALS)
    axis = int(np.argmax(np.ptp(returns, axis=(0, 1))))
    frame = replace(_RETURNS, labels=("", family.section.axes.symbols[axis]))
    numbers = (values[:, None] for values in (family.stability_index, family.period, family.action))
    limits = (_INDEX_LIMITS, None, None)
    return [_Curves(frame, returns[..., axis]), *map(_Curves, (_INDEX, _PERIOD, _ACTION), numbers, limits)]


def family_charts(family: OrbitFamily, palette: Palette, settings: Settings = NO_SETTINGS) -> list[Chart]:
    """Return the charts of the returns, the stability index, the period and the action against what changes along the family.

    Empty for a family with one member only.
    """
    return [_chart(family, curves, labelled=k == 0) for k, curves in enumerate(_curves_of(family))] if len(family) > 1 else []


def _chart(family: OrbitFamily, curves: _Curves, *, labelled: bool) -> Chart:
    """Return a chart; in the chart of the stability index, with the limits of stable orbits."""
    frame, columns = curves.frame, curves.values.T
    lines = [one for k, values in enumerate(columns) for one in _lines(family, values, labelled=labelled and k == 0)]
    special = _special(family, columns[0], "special points" if labelled else "")
    bounds = np.array([family.value.min(), family.value.max()])
    levels = (-1.0, 1.0) if frame is _INDEX else ()
    dashed = [Series("", THRESHOLD, bounds, np.full(2, level), Shape.DASHED) for level in levels]
    frame = replace(frame, labels=(family.symbol, frame.labels[1]))
    return Chart(frame, [*lines, *special, *dashed], (None, curves.limits))


def _lines(family: OrbitFamily, values: np.ndarray, *, labelled: bool) -> list[Series]:
    """Return the curve of values along the family: thick where the orbits are stable."""
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
        series.append(Series(label, STABILITY_COLOURS[kind], family.value[rows], values[rows], shape))
        begin = end
    return series


def _special(family: OrbitFamily, values: np.ndarray, label: str) -> list[Series]:
    """Return the special points of a family on the curve of values."""
    if not family.special:
        return []
    rows = np.array([point.member for point in family.special])
    notes = [_name(family, point) for point in family.special]
    return [Series(label, SPECIAL, family.value[rows], values[rows], Shape.RINGS, notes=notes)]


def _changes(subject: Subject, axis: str, family: OrbitFamily, click: Click) -> Changes:
    """Return the system and the energy of the member nearest to the click, and its start at the return nearest to it.

    With folds, several members have the same energy, so the member depends on the chart and on the height of the click.
    """
    curves = next(each for each in _curves_of(family) if each.frame.name == click.chart)
    across = (family.value - click.x)[:, None] / (np.ptp(family.value) or 1.0)
    distances = np.hypot(across, (curves.values - click.y) / curves.height)
    number, start = np.unravel_index(np.argmin(distances), distances.shape)
    member = family[int(number)]
    changes = {"energy": member.energy, **start_through(family.section, member.potential, member.states[start], member.energy)}
    if axis == ENERGY:
        return changes
    starts = (changes.pop("start"),) if "start" in changes else ()
    return {"system": member.potential.system, "window": None, "starts": starts, "chosen": 0, **changes}


def _sentence(family: OrbitFamily) -> str:
    named = [_name(family, point) for point in family.special if point.kind is not SpecialKind.RESONANCE]
    more = f" and {len(named) - _MOST_NAMED} more" if len(named) > _MOST_NAMED else ""
    special = f" {', '.join(named[:_MOST_NAMED]).capitalize()}{more}." if named else ""
    if not family.complete:
        return f"{family.describe()}{special}"
    ends = f" Lower end: {family.ends[0]}. Upper end: {family.ends[1]}."
    return f"{family.describe()}{special}{ends}"


def _name(family: OrbitFamily, point: SpecialPoint) -> str:
    return f"{point.name} at {family.symbol} = {format_number(point.value, _DIGITS)}"


FAMILY_STUDY = Study(
    name="family",
    title="Family",
    tab="periodic",
    needs_orbit=True,
    button="Follow the family",
    hint="The family of the periodic orbit nearest to the chosen orbit, with its special points: a few seconds, or a minute "
    "against a parameter.",
    axes=energy_and_parameters,
    job=_job,
    sentence=_sentence,
    invitation=lambda family: "Click a curve to open a member." if len(family) > 1 else "",
    frames=(_RETURNS, _INDEX, _PERIOD, _ACTION),
    charts=family_charts,
    changes=_changes,
    files="family",
    figure="Family of periodic orbits",
    caption=lambda family: f"{family.potential.name}: {family.describe()}",
)
"""How a periodic orbit changes with the energy or a parameter: where its island is born, divides and vanishes."""
