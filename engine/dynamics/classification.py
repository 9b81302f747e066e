"""What became of a list of orbits."""

from __future__ import annotations

import threading
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.fates import Fate
from engine.dynamics.lyapunov_orbits import exit_curves
from engine.potentials.potential import Potential
from engine.validation import LARGEST_NUMBER, read_array, read_number, read_t_max

ENERGY_TOLERANCE = 1e-9
"""Most that a start's energy may differ from the energy it is said to have."""


@dataclass(frozen=True, eq=False)
class Outcomes:
    """What became of n orbits: the arrays that `classify_orbits` returns.

    Attributes
    ----------
    fate
        int8 codes: channel k ≥ 1, or a `Fate`.
    escape_time
        float64, time of the outward crossing of the Lyapunov orbit; NaN for orbits that have not left.
    crossings
        int32, upward crossings of y = 0 (start not counted) before the escape, or until t_max; 0 where there is no orbit.
    energy_error
        float64, |H − h| / |h| at the end; NaN where there is no orbit.
    """

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    energy_error: np.ndarray


def read_outcomes(potential: Potential, energy: np.ndarray, batch: OrbitBatch) -> Outcomes:
    """The outcomes of a batch as it stands; energy (n,) is what the error is measured against."""
    orbit = (batch.fate >= Fate.BOUNDED) | (batch.fate == Fate.NOT_COMPUTED)
    crossings = np.where(orbit, batch.crossings + batch.last_crossings, 0).astype(np.int32)
    error = np.abs(potential.energy(batch.state) - energy) / np.maximum(np.abs(energy), np.finfo(float).tiny)
    decided = batch.fate >= Fate.BOUNDED
    return Outcomes(
        batch.fate.copy(), np.where(batch.fate >= 1, batch.t, np.nan), crossings, np.where(decided, error, np.nan)
    )  # fmt: skip


def classify_orbits(
    potential: Potential,
    energy: float,
    states: Any,
    t_max: float = 1e5,
    *,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Outcomes:
    """Fate, escape time and crossings of any list of orbits of one energy.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        h, finite, dimensionless.
    states
        (n, 4) x, y, px, py; finite, all on that energy to 1e-9.
    t_max
        How long each orbit is followed, 0 < t_max ≤ 1e8.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, orbits not yet decided stay `Fate.NOT_COMPUTED`.

    Raises
    ------
    ValueError
        When a state is not finite or not on the energy, or a parameter is out of its range.
    """
    states = _checked_states(potential, energy, states)
    t_max = read_t_max(t_max)
    curves = exit_curves(potential, energy)[None]
    batch = OrbitBatch.from_starts(states, np.zeros(len(states), np.int64))
    everything = np.arange(len(states))
    batch.mark_outside(everything, curves)
    propagate_batch(potential, curves, batch, everything, t_max, final=True, executor=executor, cancel=cancel)
    return read_outcomes(potential, np.full(len(states), float(energy)), batch)


def _checked_states(potential: Potential, energy: float, states: Any) -> np.ndarray:
    energy = read_number("energy", energy)
    states_array: np.ndarray = np.ascontiguousarray(read_array("states", states))
    if states_array.ndim != 2 or states_array.shape[1] != 4:
        raise ValueError(f"states of shape {states_array.shape}: must be (n, 4) with columns x, y, px, py")
    usable = (np.abs(states_array) <= LARGEST_NUMBER).all(axis=1)
    if not usable.all():
        row = int(np.argmin(usable))
        raise ValueError(f"states: row {row} holds a number that is not finite, or beyond {LARGEST_NUMBER:g}")
    off = np.abs(potential.energy(states_array) - energy)
    if np.any(off > ENERGY_TOLERANCE * potential.length**2):
        row = int(np.argmax(off))
        raise ValueError(
            f"states: row {row} has energy {float(potential.energy(states_array[row]))!r}; "
            f"all must have energy={energy} to {ENERGY_TOLERANCE:g}"
        )
    return states_array
