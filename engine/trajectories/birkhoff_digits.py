"""Birkhoff digits of one orbit: the number of digits to which averages over two consecutive time windows agree."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from engine.evidence.birkhoff_averages import TORUS_DIGITS, WINDOWS, count_agreeing_digits
from engine.exits.exit_rows import exit_curves_if_known
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.result import Chart, RecordedResult
from engine.foundations.validation import checked_state, checks_types
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.propagation.fates import Fate
from engine.systems.potential import Potential
from engine.systems.well_units import TIME


@dataclass(frozen=True, eq=False, repr=False)
class BirkhoffDigits(RecordedResult):
    """Digits to which weighted averages over two consecutive windows agree, by window length; arrays are read-only.

    Attributes
    ----------
    windows
        (m,) increasing window lengths T, dimensionless; the orbit is bounded for 2T. Empty without windows, see
        `compute_birkhoff_digits`.
    digits
        (m,) agreeing digits, above 0 and at most 16. On a recognised torus the last value is 8 or more.
    time_unit
        Unit of time of the well before rounding, 1/ω; the windows are multiples of it.
    """

    windows: np.ndarray = field(metadata=TIME)
    digits: np.ndarray
    time_unit: float = field(default=1.0, metadata=TIME)
    chart: ClassVar = Chart("windows", "digits", "window", "digits", logarithmic="x")


@checks_types(potential=Potential, execution=Execution)
def compute_birkhoff_digits(
    potential: Potential, state: Any, t_max: float, *, execution: Execution = DEFAULT_EXECUTION
) -> BirkhoffDigits:
    """Compare weighted Birkhoff averages of x² and y² over two consecutive windows, for increasing window lengths.

    The number of agreeing digits rises quickly with the window length on a torus and stays at 1 to 3 along a chaotic orbit (Das,
    Saiki, Sander & Yorke 2017, Nonlinearity 30, 4111; Sander & Meiss 2020, Physica D 411, 132569; Duignan & Meiss 2023, Physica D
    449, 133749). `engine.evidence.birkhoff_averages` describes the weight function. The computation runs in the calling
    thread and stops at the first window with `TORUS_DIGITS` digits.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py at the start of the first window; finite, dimensionless.
    t_max
        Largest total time of two windows, 0 < t_max ≤ 1e8, dimensionless. At most 128 000 time units of the well are used.
    execution
        How the computation runs.

    Returns
    -------
    The `BirkhoffDigits` for T = 1000, 4000, 16 000 and 64 000 time units of the well, as long as the orbit is bounded for 2T ≤
    t_max. There are no windows for an orbit along an axis, where one coordinate is always 0, nor around bodies, where the digits
    of regular and chaotic orbits are not known.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If `state` is not four finite numbers or `t_max` is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, integrate_orbit
    >>> integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=2000.0).compute_birkhoff_digits().digits.round(1)
    array([8.9])
    """
    start = checked_state("state", state)
    t_max = potential.checked_t_max(t_max)
    units = potential.units
    result = _compare_windows(potential.in_well_units, start[None] / units.state, t_max / units.time, execution)
    return replace(units.restore(result), made_by=potential.describe_run(energy=float(potential.energy(start)), t_max=t_max))


def _compare_windows(potential: Potential, start: np.ndarray, t_max: float, execution: Execution) -> BirkhoffDigits:
    """Apply `compute_birkhoff_digits` to a state (1, 4) in units of the well."""
    curves = exit_curves_if_known(potential, float(potential.energy(start)[0]))[0][None]
    orbit = OrbitBatch.from_starts(start, np.zeros(1, np.int64))
    orbit.mark_outside(potential, np.arange(1), curves, execution=execution.in_this_thread())
    digits: list[float] = []
    # The rounded units of the well are not used here, because verdicts must not depend on the user's units.
    unit = potential.well.exact_time_unit
    windows = [window * unit for window in WINDOWS]
    for window in windows:
        if potential.gaps or 2.0 * window > t_max or not _stays_inside(potential, curves, orbit, 2.0 * window, execution):
            break
        agreeing_digits = count_agreeing_digits(potential, start, window, execution=execution.in_this_thread())[0]
        execution.raise_if_cancelled()
        # 0 means that the averages cannot be compared.
        if agreeing_digits == 0.0:
            break
        digits.append(float(agreeing_digits))
        if agreeing_digits >= TORUS_DIGITS:
            break
    return BirkhoffDigits(np.array(windows[: len(digits)]), np.array(digits), unit)


def _stays_inside(potential: Potential, curves: np.ndarray, orbit: OrbitBatch, t_end: float, execution: Execution) -> bool:
    """Continue a batch of one orbit, and return whether it has not escaped by `t_end`."""
    propagate_batch(potential, curves, orbit, np.arange(1), t_end, final=False, execution=execution.in_this_thread())
    execution.raise_if_cancelled()
    return bool(orbit.fate[0] == Fate.NOT_COMPUTED)
