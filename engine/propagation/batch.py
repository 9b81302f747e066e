"""A batch of orbits as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from engine.exits.interior import find_outside_starts
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, run_parts
from engine.integrator.kernels.propagate import Orbits
from engine.propagation.fates import Evidence, Fate
from engine.systems.potential import Potential


@dataclass
class OrbitBatch:
    """The states and results of n orbits; their propagation can be continued at any time. Methods take orbits by their `indices`.

    Attributes
    ----------
    state
        (n, 4) x, y, px, py at time `t`, when the orbit escaped or its next step starts.
    t
        (n,) time reached; the escape time of an escaped orbit.
    crossings
        (n,) crossings of the section until `t`.
    last_crossings
        (n,) crossings between `t` and t_max of a bounded orbit.
    fate
        (n,) int8 codes, see `Fate`.
    curve_row
        (n,) the row of `curves` for the energy of the orbit, see `propagate_batch`.
    outside
        (n,) int8: number of the outcome beyond whose exit the start lies; 0 for a start inside.
    evidence
        (n,) int8 codes, see `Evidence`: why an orbit is bounded although it was not integrated to t_max; 0 for other orbits.
    remainder
        (n, 2) rounding errors of x and y of `state`, see `engine.integrator.kernels.propagate.Orbits`.
    tested
        (n,) time on the orbit at which evidence was last searched for, dimensionless; 0 before the first search.
    digits
        (n,) digits to which averages agreed in the last search, see `BoundedOrbitSearch`; infinite before the first search.
    """

    state: np.ndarray
    t: np.ndarray
    crossings: np.ndarray
    last_crossings: np.ndarray
    fate: np.ndarray
    curve_row: np.ndarray
    outside: np.ndarray
    evidence: np.ndarray
    remainder: np.ndarray
    tested: np.ndarray
    digits: np.ndarray

    @classmethod
    def empty(cls, curve_row: np.ndarray) -> OrbitBatch:
        """Return n orbits whose starts are set later."""
        n = curve_row.size
        return cls(
            state=np.full((n, 4), np.nan),
            t=np.zeros(n),
            crossings=np.zeros(n, np.int64),
            last_crossings=np.zeros(n, np.int64),
            fate=np.full(n, Fate.NOT_COMPUTED, np.int8),
            curve_row=curve_row,
            outside=np.zeros(n, np.int8),
            evidence=np.zeros(n, np.int8),
            remainder=np.zeros((n, 2)),
            tested=np.zeros(n),
            digits=np.full(n, np.inf),
        )

    @classmethod
    def from_starts(cls, states: np.ndarray, curve_row: np.ndarray) -> OrbitBatch:
        """Return orbits at t = 0; `mark_outside` finds those that start outside."""
        batch = cls.empty(curve_row)
        batch.set_starts(np.arange(curve_row.size), states)
        return batch

    def set_starts(self, indices: np.ndarray, states: np.ndarray) -> None:
        """Set some orbits to `states`, (m, 4), at t = 0; orbits with a non-finite state are forbidden."""
        self.state[indices] = states
        self.fate[indices[~np.isfinite(states).all(axis=1)]] = Fate.FORBIDDEN

    def set_outcomes(
        self, fate: np.ndarray, escape_time: np.ndarray, crossings: np.ndarray, outside: np.ndarray, evidence: np.ndarray
    ) -> None:
        """Set the outcomes (n,) of all orbits, but not their states."""
        self.fate[:], self.crossings[:], self.outside[:], self.evidence[:] = fate, crossings, outside, evidence
        self.t[:] = np.where(fate > 0, escape_time, 0.0)

    def mark_outside(
        self,
        potential: Potential,
        indices: np.ndarray,
        curves: np.ndarray,
        *,
        execution: Execution = DEFAULT_EXECUTION,
    ) -> np.ndarray:
        """Set `outside` and `fate` of the orbits among `indices` that start outside the exits.

        Returns the indices of the orbits that were tested: all, unless the test was cancelled.
        """
        # An empty part, in case no part is tested.
        tested_parts = [indices[:0]]
        for part, outcomes in run_parts(
            _find_outside, indices, lambda part: (potential, self.state[part], curves, self.curve_row[part]),
            execution=execution,
        ):  # fmt: skip
            self.outside[part] = outcomes
            self.fate[part[outcomes > 0]] = Fate.OUTSIDE
            tested_parts.append(part)
        return np.concatenate(tested_parts)

    def mark_bounded(self, indices: np.ndarray, evidence: np.ndarray | int) -> None:
        """Store the evidence of some orbits, (m,) or one code for all; orbits with evidence become bounded."""
        self.evidence[indices] = evidence
        self.fate[indices[self.evidence[indices] != Evidence.NONE]] = Fate.BOUNDED

    def copy_to_images(self, indices: np.ndarray, images: np.ndarray, numbers: np.ndarray) -> None:
        """Copy the results of some orbits to their exact mirror images under x → −x.

        Parameters
        ----------
        indices, images
            (m,) indices of the orbits and of their mirror images.
        numbers
            (m, outcomes + 1) the mirror image of each fate, see `Well.mirror_numbers`.
        """
        self.state[images] = self.state[indices] * [-1.0, 1.0, -1.0, 1.0]
        self.remainder[images] = self.remainder[indices] * [-1.0, 1.0]
        for name in ("t", "crossings", "last_crossings"):
            getattr(self, name)[images] = getattr(self, name)[indices]
        fate, row = self.fate[indices], np.arange(indices.size)
        self.fate[images] = np.where(fate > 0, numbers[row, np.maximum(fate, 0)], fate)
        self.outside[images] = numbers[row, self.outside[indices]]
        has_evidence = self.evidence[indices] != Evidence.NONE
        self.evidence[images] = np.where(has_evidence, Evidence.MIRRORED, Evidence.NONE)

    def reopen(self, indices: np.ndarray) -> None:
        """Make some bounded orbits undecided again, so that they can be continued."""
        self.fate[indices], self.evidence[indices] = Fate.NOT_COMPUTED, Evidence.NONE
        self.last_crossings[indices] = 0

    def final_evidence(self) -> np.ndarray:
        """Return the `Evidence` of each orbit, including `Evidence.INTEGRATED`; int8, of shape (n,)."""
        is_integrated = (self.fate == Fate.BOUNDED) & (self.evidence == Evidence.NONE)
        return np.where(is_integrated, np.int8(Evidence.INTEGRATED), self.evidence)

    def for_kernels(self, pending: np.ndarray) -> Orbits:
        """Return the arrays that `propagate` changes in place. `pending`, uint8 (n,), is 1 for the orbits to propagate."""
        return Orbits(self.state, self.t, self.crossings, self.last_crossings, self.fate, pending, self.remainder)

    @property
    def nbytes(self) -> int:
        """Total size of the arrays in bytes."""
        return sum(getattr(self, field.name).nbytes for field in fields(self))

    def take(self, indices: np.ndarray) -> OrbitBatch:
        """Return a copy of some orbits."""
        return replace(self, **{field.name: getattr(self, field.name)[indices] for field in fields(self)})

    def put(self, indices: np.ndarray, orbits: OrbitBatch) -> None:
        """Replace some orbits by `orbits`."""
        for field in fields(self):
            getattr(self, field.name)[indices] = getattr(orbits, field.name)


def _find_outside(potential: Potential, states: np.ndarray, curves: np.ndarray, curve_row: np.ndarray) -> np.ndarray:
    """Return the number of the outcome beyond whose exit each start lies, 0 inside; int8, of shape (n,). Called in a worker."""
    every = np.arange(len(states))
    first, inverse = _find_positions(states) if len(curves) == 1 else (every, every)
    starts = states[first]
    x, y = np.ascontiguousarray(starts[:, :2].T)
    with np.errstate(invalid="ignore"):
        # At the centre of a body V = −∞, so a start of any energy has an infinite momentum there.
        energy = np.where(np.isinf(starts[:, 2:]).any(axis=1), np.inf, potential.energy(starts))
    return find_outside_starts(potential, x, y, energy, curves, curve_row[first])[inverse]


def _find_positions(states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the index of the first start at each position, and the number of the position of each start.

    On many slices, starts of one energy at the same position differ in momentum only. Forbidden starts, which have momentum NaN,
    count as one position.
    """
    position = np.where(np.isnan(states).any(axis=1), np.nan, states[:, 0] + 1j * states[:, 1])
    _, first, inverse = np.unique(position, return_index=True, return_inverse=True)
    return first, inverse
