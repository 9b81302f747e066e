"""Passages of many orbits through a surface of section, each located in the step that contains it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.exits.exit_shapes import exit_gates
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.dense_output import without_exits
from engine.integrator.kernels.lanes import VECTOR
from engine.integrator.kernels.propagate import Exits
from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.section_numbers import SectionForm, SectionNumbers
from engine.propagation.fates import Fate
from engine.propagation.tiles import run_tiles
from engine.systems.potential import Potential

# Columns of a passage that the kernel writes.
_X, _PX, _TIME, _PY, _Y = range(5)
# The order of these columns in results.
_ORDER = [_X, _Y, _PX, _PY, _TIME]


class Passages(NamedTuple):
    """Passages of n orbits through a section, and how the orbits ended.

    Attributes
    ----------
    points
        (n, count, 5) x, y, px, py and the time of each crossing; NaN for missing crossings, and for orbits that were not followed
        because of a cancellation.
    fate
        (n,) int8 `Fate` or number of the outcome at which the orbit ended. `Fate.NOT_COMPUTED` for orbits that have all
        crossings, because they were followed to the last one only, and for those that were not followed.
    """

    points: np.ndarray
    fate: np.ndarray


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
) -> Passages:
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
    """
    orbits = np.column_stack([states, curve_row])
    points = np.full((len(states), count, len(_ORDER)), np.nan)
    fate = np.full(len(states), Fate.NOT_COMPUTED, np.int8)
    tiles = run_tiles(
        _find_passages_of_tile, potential, orbits, count, curves, exit_gates(curves, section), duration, section.form,
        execution=execution, tiles_per_task=tiles_per_task,
    )  # fmt: skip
    for begin, lanes in tiles:
        end = begin + len(lanes)
        points[begin:end], fate[begin:end] = lanes["points"][..., _ORDER], lanes["fate"]
    return Passages(points, fate)


def find_passages_of_orbit(
    potential: Potential,
    start: np.ndarray,
    count: int,
    duration: float,
    section: SectionNumbers,
    curves: np.ndarray | None = None,
) -> np.ndarray:
    """Find the first crossings of a section by one orbit; in units of the well.

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
    curves
        The exits at which the orbit ends, (outcomes, columns); None if it goes on beyond all of them.

    Returns
    -------
    (n, 5) x, y, px, py and the time of each crossing, n at most `count`.
    """
    # The kernel drops the other lanes of the vector at once, because they are not numbers, and writes no passages for them.
    lanes = np.full((len(start), VECTOR), np.nan)
    lanes[:, 0] = start
    passages, counts = np.full((1, count, len(_ORDER)), np.nan), np.zeros(VECTOR, np.int64)
    fates = np.zeros(VECTOR, np.int8)
    exits = without_exits(len(potential.outcomes), VECTOR, section)
    if curves is not None:
        exits = Exits(exit_gates(curves[None], section), curves[None], np.zeros(VECTOR, np.int64))
    with np.errstate(invalid="ignore"):
        kernels = potential.well.kernels_of(section.form)
        kernels.find_section_passages(TOLERANCE, duration, exits, lanes, passages, counts, fates)
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
    """Return `points`, with columns in the order of the kernel, and `fate` of the orbits in a tile (5, lanes).

    Called in a worker. The result is a structured array, with an element for each lane.
    """
    lanes = tile.shape[1]
    passages, counts = np.full((lanes, count, len(_ORDER)), np.nan), np.zeros(lanes, np.int64)
    fates = np.full(lanes, Fate.NOT_COMPUTED, np.int8)
    exits = Exits(gates, curves, tile[4].astype(np.int64))
    kernels = potential.well.kernels_of(section)
    # The kernel writes the passages of each orbit and their number.
    with np.errstate(invalid="ignore"):
        kernels.find_section_passages(TOLERANCE, duration, exits, tile[:4].copy(), passages, counts, fates)
    fates[counts == count] = Fate.NOT_COMPUTED
    result = np.empty(lanes, [("points", float, passages.shape[1:]), ("fate", np.int8)])
    result["points"], result["fate"] = passages, fates
    return result
