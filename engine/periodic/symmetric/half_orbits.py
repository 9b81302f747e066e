"""Halves of symmetric periodic orbits: from a start on a symmetry line of the section to a crossing that may be on it again.

A symmetry with reversed time maps the orbit of a start that it leaves unchanged onto itself. If the orbit comes to another such
state after a time t, it closes after 2t, and these are its only two in a period (Lamb & Roberts 1998, Physica D 112, 1). All
quantities are in units of the well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from engine.exits.exit_rows import absent_exits
from engine.exits.saddle_orbits.orbit_parts import transition_matrices_of
from engine.foundations.execution import Execution
from engine.maps.spec import MapSpec
from engine.periodic.symmetric.reversals import Reversal
from engine.propagation.passages import find_passages


@dataclass(frozen=True, eq=False)
class HalfOrbits:
    """The orbits of the starts of a slice, up to their n-th crossings of a section.

    Attributes
    ----------
    spec
        The request, in units of the well, with crossings in both directions.
    reversal
        The symmetry that leaves all starts unchanged.
    duration
        Longest time of the crossings.
    execution
        How the computation runs.
    """

    spec: MapSpec
    reversal: Reversal
    duration: float
    execution: Execution

    def starts(self, places: np.ndarray) -> np.ndarray:
        """Return the starts at places (m, 2), of shape (m, 4)."""
        return self.spec.start_states(*places.T)

    def crossings(self, places: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the `gaps`, (n, m), at the first n crossings of the orbits from places (m, 2), and their times, (n, m).

        They are NaN beyond the last crossing, and for forbidden starts.
        """
        potential, starts = self.spec.potential, self.starts(places)
        points = np.full((len(starts), n, 5), np.nan)
        allowed = np.flatnonzero(np.isfinite(starts).all(axis=1))
        # A periodic orbit may pass over a saddle and return.
        points[allowed] = find_passages(
            potential, starts[allowed], np.zeros(allowed.size, np.int64), absent_exits(potential)[None], n, self.duration,
            self.spec.section.numbers, execution=replace(self.execution, on_progress=None),
        ).points  # fmt: skip
        return self.gaps(points[..., :4]).T, points[..., 4].T

    def gaps(self, states: np.ndarray) -> np.ndarray:
        """Return how far states (…, 4) on the section are from those that the symmetry leaves unchanged, with a sign, (…)."""
        return states @ self.reversal.coordinate

    def stability_indices(self, starts: np.ndarray, half_periods: np.ndarray) -> np.ndarray:
        """Return a = ½ (tr M − 2), (m,), of symmetric periodic orbits, from the transition matrices A of half their periods.

        The other half is the image of the first one: M = R A⁻¹ R A with the symmetry R.
        """
        factors = self.reversal.symmetry.factors
        halves = transition_matrices_of(self.spec.potential, starts, half_periods)
        whole = factors[:, None] * np.linalg.solve(halves, factors[:, None] * halves)
        return 0.5 * (np.trace(whole, axis1=1, axis2=2) - 2.0)
