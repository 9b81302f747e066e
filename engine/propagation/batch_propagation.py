"""Parallel propagation of a batch of orbits, in tiles on any executor."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass

import numpy as np

from engine.exits.exit_shapes import exit_gates
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.lanes import VECTOR, fill_vectors
from engine.integrator.kernels.propagate import NO_TRACE, Exits
from engine.integrator.source.recurrence import LANES, TOLERANCE
from engine.integrator.source.section_numbers import UPWARD, SectionForm, SectionNumbers
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Fate
from engine.systems.potential import Potential

LARGEST_TILE = 2048
"""Largest number of orbits per tile."""

STEP_BUDGET = 2_000_000
"""Largest number of steps of all lanes in one kernel call. The call takes 20 to 50 ms.

Cancellation and progress are handled between calls.
"""

# Smallest number of active orbits with which few enough lanes are empty. A worker with fewer orbits returns them, so that they
# are combined with other orbits.
_LEAST_ACTIVE = LANES - 2 * VECTOR


@dataclass
class Tile:
    """A part of a batch that one worker propagates.

    Attributes
    ----------
    indices
        (n,) indices of the orbits in the whole batch.
    batch
        A copy of these orbits.
    active
        (n,) uint8: 1 for orbits that have neither escaped nor reached the horizon.
    """

    indices: np.ndarray
    batch: OrbitBatch
    active: np.ndarray

    @classmethod
    def copy_from(cls, batch: OrbitBatch, indices: np.ndarray) -> Tile:
        """Return a tile of some orbits, all active."""
        return cls(indices, batch.take(indices), np.ones(indices.size, np.uint8))


def _advance_tile(
    potential: Potential,
    curves: np.ndarray,
    gates: np.ndarray,
    tile: Tile,
    horizon: float,
    final: bool,
    tolerance: float,
    least_active: int,
    section: SectionForm | None,
) -> Tile:
    """Propagate the orbits of a tile, in place, by `STEP_BUDGET` steps, or until fewer than `least_active` are active.

    Called in a worker.
    """
    exits = Exits(gates, curves, tile.batch.curve_row)
    orbits = tile.batch.for_kernels(tile.active)
    potential.well.kernels_of(section).propagate(
        np.arange(tile.indices.size), horizon, final, tolerance, STEP_BUDGET, least_active, exits, orbits, NO_TRACE
    )
    return tile


class OrbitPool:
    """A queue of the orbits that wait for a worker.

    Parameters
    ----------
    indices
        (n,) indices of all orbits to propagate.
    workers
        Number of workers.

    Attributes
    ----------
    waiting
        Indices of the waiting orbits.
    """

    def __init__(self, indices: np.ndarray, workers: int) -> None:
        self.waiting, self._workers = indices, workers
        # Number of orbits that are with workers.
        self._taken_count = 0

    def take(self) -> np.ndarray:
        """Remove and return the indices of a worker's share of the waiting orbits: whole SIMD vectors, at most `LARGEST_TILE`."""
        share = math.ceil((self.waiting.size + self._taken_count) / self._workers)
        size = min(fill_vectors(share), LARGEST_TILE)
        indices, self.waiting = np.split(self.waiting, [size])
        self._taken_count += indices.size
        return indices

    def give_back(self, tile: Tile) -> None:
        """Queue the orbits of a tile that are still active."""
        self._taken_count -= tile.indices.size
        self.waiting = np.concatenate([self.waiting, tile.indices[tile.active != 0]])


def propagate_batch(
    potential: Potential,
    curves: np.ndarray,
    batch: OrbitBatch,
    indices: np.ndarray,
    horizon: float,
    *,
    final: bool,
    execution: Execution = DEFAULT_EXECUTION,
    on_tiles: Callable[[], None] = lambda: None,
    tolerance: float = TOLERANCE,
    section: SectionNumbers = UPWARD,
) -> bool:
    """Integrate undecided orbits until they escape or reach `horizon`; the batch is changed in place.

    The result of each orbit is bit-identical for every executor and for every pattern of interruptions. All quantities are in
    units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    curves
        (energies, outcomes, columns) exits, see `exit_curves`.
    batch
        The orbits.
    indices
        Indices of the orbits; decided orbits are left as they are.
    horizon
        Time at which to stop, dimensionless.
    final
        Whether the horizon is t_max: orbits that reach it become bounded.
    execution
        How the computation runs. When it is cancelled, the propagation stops early; another call can continue it.
    on_tiles
        Called after each group of completed tiles.
    tolerance
        Tolerance of the Taylor steps, see `engine.integrator.source.recurrence.TOLERANCE`.
    section
        The surface of section at which crossings are counted, see `Section.numbers`.

    Returns
    -------
    Whether the propagation was completed; False if it was cancelled.
    """
    workers = execution.workers
    gates = exit_gates(curves, section)
    undecided = indices[(batch.fate[indices] == Fate.NOT_COMPUTED) & (batch.t[indices] < horizon)]
    pool = OrbitPool(undecided, workers)
    running: set[Future[Tile]] = set()

    def keep_workers_busy() -> None:
        # Tiles are queued ahead only while enough orbits for a full tile wait.
        while pool.waiting.size and len(running) < (2 * workers if pool.waiting.size > LARGEST_TILE else workers):
            tile = Tile.copy_from(batch, pool.take())
            # Without other orbits to combine with, a worker keeps its orbits.
            least_active = _LEAST_ACTIVE if pool.waiting.size and tile.indices.size > _LEAST_ACTIVE else 0
            arguments = potential, curves, gates, tile, horizon, final, tolerance, least_active, section.form
            running.add(execution.submit(_advance_tile, *arguments))

    keep_workers_busy()
    while running:
        done, running = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            tile = execution.collect(future)
            # None after a cancellation.
            if tile is not None:
                batch.put(tile.indices, tile.batch)
                pool.give_back(tile)
        if not execution.is_cancelled:
            keep_workers_busy()
            on_tiles()
    return not execution.is_cancelled
