"""Passages of many orbits through a surface of section, each located in the step that contains it."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_shapes import exit_gates
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.dense_output import without_exits
from engine.integrator.kernels.propagate import VECTOR, Exits
from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.section_numbers import SectionForm, SectionNumbers
from engine.propagation.tiles import map_tiles
from engine.systems.potential import Potential

# Columns of a passage that the kernel writes.
_X, _PX, _TIME, _PY, _Y = range(5)
# The order of these columns in results.
_ORDER = [_X, _Y, _PX, _PY, _TIME]


def find_passages(
    potential: Potential,
    states: np.ndarray,
    curve_row: np.ndarray,
    curves: np.ndarray,
    count: int,
    duration: float,
    section: SectionNumbers,
    *,
    execution: Execution = DEFAULT_EXECUTION,
    tiles_per_task: int = 1,
) -> np.ndarray:
    """Find the first crossings of a section by orbits before they end, not counting the starts.

    All quantities are in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    states
        (n, 4) x, y, px, py of the starts, inside all exits.
    curve_row
        (n,) the row of `curves` for the energy of each orbit.
    curves
        (energies, outcomes, columns) exits, see `exit_curves`.
    count
        Number of crossings of each orbit, at least 1.
    duration
        Time at which to stop, above 0.
    section
        The section, see `Section.numbers`.
    execution
        How the computation runs.
    tiles_per_task
        See `map_tiles`.

    Returns
    -------
    (n, count, 5) x, y, px, py and the time of each crossing; NaN for missing crossings, and for orbits that were not followed
    because of a cancellation.
    """
    orbits = np.column_stack([states, curve_row])
    passages = map_tiles(
        _find_passages_of_tile, potential, orbits, count, curves, exit_gates(curves, section), duration, section.form,
        shape=(count, len(_ORDER)), execution=execution, tiles_per_task=tiles_per_task,
    )  # fmt: skip
    return passages[..., _ORDER]


def find_passages_of_orbit(
    potential: Potential, start: np.ndarray, count: int, duration: float, section: SectionNumbers
) -> np.ndarray:
    """Find the first crossings of a section by one orbit, whether or not it leaves through an exit; in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    start
        (4,) x, y, px, py.
    count
        Largest number of crossings.
    duration
        Time at which to stop, above 0.
    section
        The section, see `Section.numbers`.

    Returns
    -------
    (n, 5) x, y, px, py and the time of each crossing, n at most `count`.
    """
    # The kernel drops the other lanes of the vector at once, because they are not numbers, and writes no passages for them.
    lanes = np.full((len(start), VECTOR), np.nan)
    lanes[:, 0] = start
    passages, counts = np.full((1, count, len(_ORDER)), np.nan), np.zeros(VECTOR, np.int64)
    exits = without_exits(len(potential.outcomes), VECTOR, section)
    with np.errstate(invalid="ignore"):
        kernels = potential.well.kernels_of(section.form)
        kernels.find_section_passages(TOLERANCE, duration, exits, lanes, passages, counts)
    return passages[0, : counts[0], _ORDER].T


def _find_passages_of_tile(
    potential: Potential,
    tile: np.ndarray,
    count: int,
    curves: np.ndarray,
    gates: np.ndarray,
    duration: float,
    section: SectionForm | None,
) -> np.ndarray:
    """Return the passages of the orbits in a tile (5, lanes), of shape (lanes, count, columns); called in a worker."""
    passages = np.full((tile.shape[1], count, len(_ORDER)), np.nan)
    counts = np.zeros(tile.shape[1], np.int64)
    exits = Exits(gates, curves, tile[4].astype(np.int64))
    kernels = potential.well.kernels_of(section)
    # The kernel writes the passages of each orbit and their number.
    with np.errstate(invalid="ignore"):
        kernels.find_section_passages(TOLERANCE, duration, exits, tile[:4].copy(), passages, counts)
    return passages
