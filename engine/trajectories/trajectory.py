"""Integration of one orbit: states, SALI, Lyapunov exponent, R², crossings, fate and energy error."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.evidence.birkhoff_averages import compare_halves
from engine.exits.exit_rows import exit_curves_if_known
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.validation import checked_state, checks_types
from engine.integrator.kernels.dense_output import sample_deviations, sample_path
from engine.integrator.source.section_numbers import SectionNumbers
from engine.propagation.classification import OrbitSteps, record_orbit
from engine.propagation.fates import Evidence, Fate, OrbitResult
from engine.propagation.limited_steps import DEVIATION_VECTORS
from engine.propagation.passages import find_passages_of_orbit
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section, section_of_file
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.systems.well_units import AREA, ENERGY, LENGTH, MOMENTUM, RATE, TIME
from engine.trajectories.birkhoff_digits import BirkhoffDigits, compute_birkhoff_digits

if TYPE_CHECKING:
    import xarray as xr

MAX_ORBIT_TIME = 1e7
"""Largest t_max of `integrate_orbit`. The samples of such an orbit take 3 GB."""

# Interval between samples, in units of the well, unless it gives too few or too many samples.
_SAMPLE_INTERVAL = 0.02
# Smallest number of intervals between samples.
_MIN_INTERVALS = 400
# Largest number of intervals between samples, unless there are more integration steps.
_MAX_INTERVALS = 500_000


@dataclass(frozen=True, eq=False, repr=False)
class SectionResult(OrbitResult):
    """Base of results on orbits whose crossings of a surface of section are counted.

    Attributes
    ----------
    section
        The surface of section.
    """

    section: Section = field(default=Section.Y_UP, kw_only=True)
    held_as: ClassVar[dict[str, str]] = OrbitResult.held_as | {"section": "section"}

    def to_xarray(self) -> xr.Dataset:
        """Return the dataset of a result, with the section as text."""
        return super().to_xarray().assign_attrs(section=self.section.text)

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the section, which files hold as text."""
        return {"section": section_of_file(dataset.attrs)}


@dataclass(frozen=True, eq=False, repr=False)
class Orbit(SectionResult):
    """One orbit, dimensionless, sampled at n evenly spaced times from 0 to its end or t_max; arrays are read-only.

    An orbit exactly at rest on a saddle is bounded; its samples end where rounding carries the orbit off the saddle.

    Attributes
    ----------
    t, x, y, px, py
        (n,) times and states.
    sali
        (n,) smaller alignment index min(‖w1 − w2‖, ‖w1 + w2‖) of two unit deviation vectors, 0 to √2; in units of the well.
    lyapunov_exponent
        (n,) finite-time maximal Lyapunov exponent ``(1/t) ln(|w1(t)|/|w1(0)|)`` of the first deviation vector, per unit of time;
        NaN at t = 0. It decays like ln t / t along regular orbits and converges to a positive value along chaotic orbits.
    r2
        (n,) R² = x² + y².
    fate
        k ≥ 1 for the outcome ``outcomes[k - 1]``, such as channel k, or a `Fate`, never `Fate.FORBIDDEN`.
    escape_time
        Time of the outcome: of the passage through an exit, of the collision, or of the passage of the escape radius; NaN without
        an outcome.
    crossings
        Crossings of `section` before the escape or t_max; the start is not counted.
    energy_error
        ``|H − h| / |h|`` at the end of the orbit.
    energy
        h of the initial state.
    evidence
        ``CLOSED`` if the well is closed at this energy, ``INTEGRATED`` if the orbit is bounded until t_max, otherwise ``NONE``.
    time_unit
        Unit of time of the well before rounding, 1/ω, in which the chaos indicators measure the length of an orbit.
    potential
        The `Potential`; None for an orbit that was not integrated here, whose path cannot be drawn.
    exits_unknown
        The reason why the exits over saddles are not known at this energy; empty if they are known. With a reason, no fate is an
        exit, and `Fate.BOUNDED` only means that the orbit has no other outcome by t_max.
    """

    t: np.ndarray = field(metadata=TIME)
    x: np.ndarray = field(metadata=LENGTH)
    y: np.ndarray = field(metadata=LENGTH)
    px: np.ndarray = field(metadata=MOMENTUM)
    py: np.ndarray = field(metadata=MOMENTUM)
    sali: np.ndarray
    lyapunov_exponent: np.ndarray = field(metadata=RATE)
    r2: np.ndarray = field(metadata=AREA)
    fate: int
    escape_time: float = field(metadata=TIME)
    crossings: int
    energy_error: float
    energy: float = field(metadata=ENERGY)
    evidence: Evidence
    time_unit: float = field(default=1.0, metadata=TIME)
    potential: Potential | None = field(default=None, repr=False)
    exits_unknown: str = ""
    codes: ClassVar = {"fate": Fate, "evidence": Evidence}

    @property
    def outcomes(self) -> tuple[Outcome, ...]:  # type: ignore[override]
        """The outcomes of the potential; empty without a potential."""
        return () if self.potential is None else self.potential.outcomes_at(self.energy)

    @cached_property
    def digits_of_halves(self) -> float:
        """The digits, 0 to 16, to which Birkhoff averages over both halves of the orbit agree; many on a torus."""
        return compare_halves(self.x, self.y)

    def numbers(self) -> dict[str, Any]:
        """Return the scalars by name, with the reason if exits are not known."""
        return {name: value for name, value in super().numbers().items() if name != "exits_unknown" or value}

    def find_section_crossings(self) -> np.ndarray:
        """Return the crossings of the section, (n, 2), dimensionless, in order of time; n equals `crossings`.

        The coordinates are those of `Section.axes`, on y = 0 x and px. The start is not counted. Raises ValueError if the orbit
        has no potential.

        Examples
        --------
        >>> from escape_explorer import CASES, integrate_orbit
        >>> integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=20.0).find_section_crossings().round(4)
        array([[ 0.1162, -0.042 ],
               [ 0.1585, -0.0726],
               [ 0.2122, -0.0821]])
        """
        return self.section.axes.points(self.find_section_states()[0])

    def find_section_states(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x, y, px, py, (n, 4), and the times, (n,), of the crossings of the section, see `find_section_crossings`."""
        potential = self._required_potential
        units, start = potential.units, np.array([self.x[0], self.y[0], self.px[0], self.py[0]])
        section = self.section.in_well_units(units).numbers
        found = find_passages_of_orbit(
            potential.in_well_units, start / units.state, self.crossings, float(self.t[-1]) / units.time, section
        )
        return self.section.settle(found[:, :4] * units.state), found[:, 4] * units.time

    def compute_birkhoff_digits(self, *, execution: Execution = DEFAULT_EXECUTION) -> BirkhoffDigits:
        """Compute the digits to which averages over two consecutive windows agree, for windows up to half as long as the orbit.

        The computation runs in this thread. Raises CancelledError if it is cancelled, and ValueError if the orbit has no
        potential.

        Examples
        --------
        >>> from escape_explorer import CASES, integrate_orbit
        >>> integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=2000.0).compute_birkhoff_digits().digits.round(1)
        array([8.9])
        """
        start = (self.x[0], self.y[0], self.px[0], self.py[0])
        return compute_birkhoff_digits(self._required_potential, start, float(self.t[-1]), execution=execution)

    @property
    def _required_potential(self) -> Potential:
        """The potential; ValueError if the orbit has none."""
        if self.potential is None:
            raise ValueError("this orbit has no potential; must be one of `integrate_orbit`")
        return self.potential


@checks_types(potential=Potential, execution=Execution)
def integrate_orbit(
    potential: Potential,
    state: Any,
    t_max: float = 1e5,
    *,
    section: Section | str = Section.Y_UP,
    execution: Execution = DEFAULT_EXECUTION,
) -> Orbit:
    """Integrate one orbit until it escapes or up to `t_max`.

    Fate, escape time and crossings are identical to those of a map pixel with the same start. The deviation vectors obey eq. 4
    of Zotos (2014), and SALI is given by eq. 9. The growth of the first vector gives the finite-time Lyapunov exponent (Benettin,
    Galgani, Giorgilli & Strelcyn 1980, Meccanica 15, 9; Skokos 2010, Lect. Notes Phys. 790, 63). The deviation vectors have no
    influence on the integration steps. If the exits are not defined at the energy, see `find_lyapunov_orbits`, the orbit is
    integrated without exits, and `Orbit.exits_unknown` has the reason.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py; finite, dimensionless. Its energy determines the exits.
    t_max
        Longest integration time, 0 < t_max ≤ 1e7, dimensionless. Above about 1e5, there is at least one sample per integration
        step, which takes about 300 bytes per time unit.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`.
    execution
        How the computation runs.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If `state` is not four finite numbers, `t_max` is out of range, or `section` is not legal.

    Examples
    --------
    >>> from escape_explorer import CASES, integrate_orbit
    >>> orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), t_max=100.0)
    >>> orbit.fate, round(orbit.escape_time, 4), orbit.to_pandas().shape[1]
    (1, 15.1781, 8)
    """
    start = checked_state("state", state)
    t_max = potential.checked_t_max(t_max, MAX_ORBIT_TIME)
    units, section = potential.units, checked_section(section)
    numbers = section.in_well_units(units).numbers
    orbit = _integrate(potential.in_well_units, start / units.state, t_max / units.time, numbers, execution)
    made_by = potential.describe_run(t_max=t_max)
    return replace(units.restore(orbit), potential=potential, section=section, made_by=made_by)


def _integrate(potential: Potential, start: np.ndarray, t_max: float, section: SectionNumbers, execution: Execution) -> Orbit:
    """Apply `integrate_orbit` in units of the well."""
    energy = float(potential.energy(start))
    curves, exits_unknown = exit_curves_if_known(potential, energy)
    orbit_steps = record_orbit(potential, start, curves, t_max, execution, section)
    times, (x, y, px, py), sali, exponent = _sample_orbit(potential, start, orbit_steps, execution)
    arrays = (times, x, y, px, py, sali, exponent, x * x + y * y)
    # The columns of one orbit are arrays of length 1, in this order.
    fate, escape_time, crossings, energy_error = (values[0].item() for values in orbit_steps.outcomes.columns().values())
    evidence = _find_evidence(potential, energy, fate)
    numbers = fate, escape_time, crossings, energy_error, energy, evidence, potential.well.exact_time_unit
    return Orbit(*arrays, *numbers, exits_unknown=exits_unknown)


def _find_evidence(potential: Potential, energy: float, fate: int) -> Evidence:
    """Return why an orbit is bounded, see `Orbit.evidence`."""
    if fate != Fate.BOUNDED:
        return Evidence.NONE
    return Evidence.CLOSED if potential.well.is_closed_at(energy) else Evidence.INTEGRATED


def _sample_orbit(
    potential: Potential, start: np.ndarray, orbit_steps: OrbitSteps, execution: Execution
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return times (n,), path (4, n), SALI (n,) and Lyapunov exponent (n,) from start to end, all in units of the well."""
    steps, t_end = orbit_steps.steps, orbit_steps.t_end
    if t_end == 0.0:
        # The deviation vectors are orthonormal, so SALI is √2.
        return np.zeros(1), start[:, None].copy(), np.full(1, np.sqrt(2.0)), np.full(1, np.nan)
    kernels = potential.well.kernels
    times = np.linspace(0.0, t_end, _sample_count(t_end, len(steps)))
    all_times = np.union1d(times, _starts_of_short_steps(times, steps[:, 4]))
    path = sample_path(kernels, steps, all_times, execution)
    sali, growth = sample_deviations(kernels, path, all_times, DEVIATION_VECTORS, execution)
    index = np.searchsorted(all_times, times)
    exponent = np.full_like(times, np.nan)
    with np.errstate(over="ignore"):
        # The quotient by a very short time can overflow.
        np.divide(growth[index], times, out=exponent, where=times > 0.0)
    return times, np.ascontiguousarray(path[:, index]), sali[index], exponent


def _starts_of_short_steps(times: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Return the start times of the steps in those intervals between samples that contain a whole step, as near a body.

    One series carries the deviation vectors over an interval. It is valid for about one step only.
    """
    interval = np.searchsorted(times, starts, side="right") - 1
    # With two starts in an interval, the step from one to the other is inside.
    contains_step = np.bincount(interval, minlength=times.size) > 1
    return starts[contains_step[interval]]


def _sample_count(t_end: float, step_count: int) -> int:
    """Return the number of samples: more than there are integration steps, and more still for short orbits."""
    return max(int(np.clip(t_end / _SAMPLE_INTERVAL, _MIN_INTERVALS, _MAX_INTERVALS)), step_count) + 1
