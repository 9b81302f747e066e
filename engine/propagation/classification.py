"""Outcomes of orbits: of many orbits, and of one orbit with its steps."""

from __future__ import annotations

from concurrent.futures import CancelledError
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar

import numpy as np

from engine.exits.exit_rows import closed_exits, exit_curves_at
from engine.exits.exit_shapes import exit_gates
from engine.foundations.execution import Execution
from engine.integrator.kernels.dense_output import trace_orbit
from engine.integrator.kernels.propagate import Exits
from engine.integrator.source.section_numbers import UPWARD, SectionNumbers
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.propagation.fates import Fate, OrbitResult
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.systems.well_units import TIME


@dataclass(frozen=True, eq=False, repr=False)
class Outcomes(OrbitResult):
    """Outcomes of n orbits, as returned by `classify_orbits`; arrays are read-only.

    Attributes
    ----------
    fate
        int8 codes: k ≥ 1 for the outcome ``outcomes[k - 1]``, such as channel k, or a `Fate`.
    escape_time
        float64, time of the outcome: of the passage through an exit, of the collision, or of the passage of the escape radius;
        NaN without an outcome.
    crossings
        int32, crossings of the section, by default of y = 0 upward, before the escape or until t_max; the start is not counted; 0
        if there is no orbit.
    energy_error
        float64, ``|H − h| / |h|`` at the end; NaN if there is no orbit.
    t_max
        Integration time of the orbits that have not escaped; infinite if it is not known.
    outcomes
        The outcomes of the potential, see `Potential.outcomes`; empty if they are not known.
    """

    fate: np.ndarray
    escape_time: np.ndarray = field(metadata=TIME)
    crossings: np.ndarray
    energy_error: np.ndarray
    t_max: float = field(default=float("inf"), metadata=TIME)
    outcomes: tuple[Outcome, ...] = ()
    codes: ClassVar = {"fate": Fate}
    row_dimension: ClassVar = "orbit"


def collect_outcomes(potential: Potential, energy: np.ndarray, batch: OrbitBatch) -> Outcomes:
    """Return the outcomes of a batch so far, in the units of its states; energy errors are relative to `energy` (n,)."""
    is_orbit = (batch.fate >= Fate.BOUNDED) | (batch.fate == Fate.NOT_COMPUTED)
    crossings = np.where(is_orbit, batch.crossings + batch.last_crossings, 0).astype(np.int32)
    is_decided = batch.fate >= Fate.BOUNDED
    reference = energy[is_decided]
    difference = np.abs(potential.energy(batch.state[is_decided]) - reference)
    error = np.full(batch.fate.size, np.nan)
    error[is_decided] = difference / np.maximum(np.abs(reference), np.finfo(float).tiny)
    escape_time = np.where(batch.fate >= 1, batch.t, np.nan)
    return Outcomes(batch.fate.copy(), escape_time, crossings, error)


def classify_in_well_units(
    potential: Potential,
    energies: np.ndarray,
    states: np.ndarray,
    t_max: float,
    execution: Execution,
    section: SectionNumbers = UPWARD,
) -> Outcomes:
    """Return the outcomes of orbits, without `t_max` and `outcomes`; all quantities are in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    energies
        (n,) the energy of each orbit; NaN for forbidden starts. The exits are found at each different energy.
    states
        (n, 4) x, y, px, py of the starts, with these energies; NaN in forbidden starts.
    t_max
        Largest integration time, above 0, dimensionless.
    execution
        How the computation runs. When it is cancelled, orbits without a result stay `Fate.NOT_COMPUTED`.
    section
        The surface of section at which crossings are counted, see `Section.numbers`.
    """
    is_orbit = np.isfinite(energies)
    values, row = np.unique(energies[is_orbit], return_inverse=True)
    curve_row = np.zeros(len(states), np.int64)
    curve_row[is_orbit] = row
    batch = OrbitBatch.from_starts(states, curve_row)
    orbits = np.flatnonzero(batch.fate == Fate.NOT_COMPUTED)
    # A cancelled search for the exits leaves all orbits as they are.
    with suppress(CancelledError):
        curves = exit_curves_at(potential, values, execution) if orbits.size else closed_exits(potential)[None]
        batch.mark_outside(potential, orbits, curves, execution=execution)
        propagate_batch(
            potential, curves, batch, orbits, t_max, final=True, execution=execution,
            on_tiles=lambda: execution.report(partial(_share_done, batch, t_max)), section=section,
        )  # fmt: skip
    return collect_outcomes(potential, energies, batch)


def _share_done(batch: OrbitBatch, t_max: float) -> float:
    """Return the share of the total integration time that is done; an orbit that has ended counts as done."""
    return float(np.where(batch.fate == Fate.NOT_COMPUTED, np.minimum(batch.t / t_max, 1.0), 1.0).mean())


@dataclass(frozen=True, eq=False)
class OrbitSteps:
    """The steps and the outcome of an orbit, in units of the well.

    Attributes
    ----------
    outcomes
        The `Outcomes` of this orbit, equal to the bit to its outcomes in a map.
    steps
        (m, 5) x, y, px, py, t at the start of each step; (0, 5) for a start outside.
    t_end
        Time of the escape, or t_max; 0 for a start outside.
    """

    outcomes: Outcomes
    steps: np.ndarray
    t_end: float


def record_orbit(
    potential: Potential,
    start: np.ndarray,
    curves: np.ndarray,
    t_max: float,
    execution: Execution,
    section: SectionNumbers = UPWARD,
) -> OrbitSteps:
    """Integrate one orbit until it escapes or reaches `t_max`, and keep its steps; all quantities are in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    start
        (4,) x, y, px, py.
    curves
        (outcomes, columns) exits at the energy of the start, see `exit_curves`.
    t_max
        Largest integration time, above 0, dimensionless.
    execution
        How to cancel the computation. The orbit is integrated in this thread.
    section
        The surface of section at which crossings are counted, see `Section.numbers`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    """
    # A batch of one orbit, and exit curves of one energy.
    batch = OrbitBatch.from_starts(start[None], np.zeros(1, np.int64))
    curve_rows = curves[None]
    batch.mark_outside(potential, np.arange(1), curve_rows, execution=execution.in_this_thread())
    pending = (batch.fate == Fate.NOT_COMPUTED).astype(np.uint8)
    orbits = batch.for_kernels(pending)
    exits = Exits(exit_gates(curve_rows, section), curve_rows, batch.curve_row)
    pieces = list(trace_orbit(potential.well.kernels_of(section.form), exits, orbits, t_max, execution))
    execution.raise_if_cancelled()
    outcomes = collect_outcomes(potential, potential.energy(start[None]), batch)
    if not pieces:
        return OrbitSteps(outcomes, np.empty((0, 5)), 0.0)
    return OrbitSteps(outcomes, np.concatenate([steps for steps, _ in pieces]), pieces[-1][1])
