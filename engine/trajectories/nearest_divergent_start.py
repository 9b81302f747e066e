"""The nearest start with a different exit, which shows how precisely a start must be known to predict its exit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.validation import checked_number, checks_types
from engine.propagation.classification import classify_in_well_units
from engine.propagation.fates import Fate, OrbitResult, name_fate
from engine.slices.axes import Energy
from engine.slices.planes import checked_slice
from engine.slices.slice import Slice
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.systems.well_units import LENGTH

# Smallest distance of a neighbour, in units of the well: a few hundred units in the last place of coordinates of order 1.
_MIN_DISTANCE = 1e-13
# Number of directions in which neighbours lie.
_DIRECTIONS = 16
# Number of neighbours in all directions together for each factor of 10 in distance.
_STARTS_PER_DECADE = 80
# Number of neighbours classified together, on the inner rings first. Around a start that escapes late, one of the first rings
# has a divergent start, so neighbours farther out, some of them bounded for much longer, need not be integrated.
_BATCH_SIZE = 128
# Number of refinements. Two, into 10 sections each, reduce the gap between two rings, a factor of at most 1.6, to less than 1 %.
_REFINEMENTS = 2
# Number of sections of a refinement.
_SECTIONS = 10
# Integration time of neighbours, in units of the escape time of the given start.
_HORIZON_FACTOR = 3.0
# Shortest integration time of neighbours, in units of the well.
_SHORTEST_HORIZON = 1000.0


@dataclass(frozen=True)
class DivergentStart(OrbitResult):
    """A neighbouring start on the same plane whose orbit has another outcome; lengths are dimensionless.

    Attributes
    ----------
    x, ordinate
        Position in the plane of initial conditions.
    distance
        Distance from the given start in that plane, with momenta in units in which the unit of time of the well is 1.
    fate
        Fate of the neighbour's orbit, k ≥ 1 for the outcome ``outcomes[k - 1]``, such as channel k.
    reference_fate
        Fate of the given start: another outcome, or a `Fate`.
    outcomes
        The outcomes of the potential, see `Potential.outcomes`; empty if they are not known.
    """

    x: float
    ordinate: float
    distance: float = field(metadata=LENGTH)
    fate: int
    reference_fate: int
    outcomes: tuple[Outcome, ...] = field(default=(), repr=False)
    codes: ClassVar = {"fate": Fate, "reference_fate": Fate}


@checks_types(potential=Potential, execution=Execution)
def find_divergent_start(
    potential: Potential,
    plane: Slice | str,
    energy: Energy,
    x: float,
    ordinate: float,
    t_max: float | None = None,
    *,
    furthest: float | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> DivergentStart | None:
    """Find the nearest neighbour of a start with a different outcome; for a bounded start, the nearest with any outcome.

    Neighbours lie on rings around the start: in 16 directions on rings that grow by a factor of 1.6 or, with an axis h, in the
    two directions of constant energy on rings that grow by a factor of 1.06. Between the first ring with a divergent start and
    the previous ring, the distance is refined to 1 % along the directions of the divergent starts. Basins narrower than the gaps
    between rings or directions can be missed.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        The slice of starts, such as a `Plane`.
    energy
        h, finite, dimensionless; ignored on a slice with an axis h.
    x, ordinate
        The start, dimensionless; neither forbidden nor outside.
    t_max
        Integration time of the given start, 0 < t_max ≤ 1e8, dimensionless. Neighbours are integrated for 1000 time units of the
        well or, if the start escapes, for three times its escape time, whichever is longer, and never beyond t_max. Neighbours
        bounded until then are not divergent.
    furthest
        Largest distance to search, finite, above 1e-13 length units of the well, dimensionless; None for one such unit.
    execution
        How the computation runs.

    Returns
    -------
    The `DivergentStart`, or None if no neighbour within `furthest` is divergent. A distance of 1e-13 length units is an upper
    bound: the search begins there.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If a parameter is out of range, or the start is forbidden or outside.

    Examples
    --------
    >>> from escape_explorer import CASES, Plane, find_divergent_start
    >>> divergent = find_divergent_start(CASES["III"], Plane.X_PX, 0.45, 0.3, 0.2, t_max=1e3)
    >>> assert divergent is not None
    >>> divergent.reference_fate, divergent.fate, round(divergent.distance, 3)
    (1, 4, 0.047)
    """
    plane = checked_slice(plane)
    h = _checked_start_energy(plane, energy, x, ordinate)
    if plane.parameter_axis is not None:
        potential = plane.potential_at(potential, x, ordinate)
        plane = plane.line((x, ordinate)[plane.parameter_axis])
    t_max = potential.checked_t_max(t_max)
    units = potential.units
    nearest = _MIN_DISTANCE * units.length
    furthest = units.length if furthest is None else checked_number("furthest", furthest, f"a finite number above {nearest:g}")
    if not furthest > nearest:
        raise ValueError(f"furthest={furthest}: must be a finite number above {nearest:g}")
    centre = np.array([x, ordinate]) / plane.axis_units(units)
    search = _Search(potential.in_well_units, plane.in_well_units(units), h / units.energy, centre, execution)
    search.classify_centre(t_max / units.time)
    if search.centre_fate in (Fate.FORBIDDEN, Fate.OUTSIDE):
        condition = plane.limiting_curve(potential.mass).replace("=", "≤")
        start = ", ".join(f"{name}={value}" for name, value in zip(plane.axis_names, (x, ordinate), strict=True))
        fate_name = name_fate(search.centre_fate)
        raise ValueError(f"{start}: {fate_name} on {plane.title} at h={h}; must have {condition} and lie inside all exits")
    divergent = search.find_nearest(furthest / units.length)
    if divergent is None:
        return None
    made_by = potential.describe_run(energy=h, plane=plane.title, t_max=t_max)
    return replace(plane.restore(divergent, units), made_by=made_by)


def _checked_start_energy(plane: Slice, energy: Energy, x: float, ordinate: float) -> float:
    """Return the energy h of the start; ValueError unless h and the coordinates are finite numbers."""
    for name, value in zip(plane.axis_names, (x, ordinate), strict=True):
        checked_number(name, value)
    if plane.energy_axis is not None:
        return float((x, ordinate)[plane.energy_axis])
    return checked_number("energy", plane.checked_energy(energy))


@dataclass(frozen=True, eq=False)
class _Bracket:
    """Bounds of the distance to the nearest divergent start.

    There is no divergent start at radius `low`. At radius `high`, there is one in each of the `directions` (m, 2), with `fates`
    (m,).
    """

    low: float
    high: float
    directions: np.ndarray
    fates: np.ndarray


class _Search:
    """Searches for divergent starts around the start `centre` (2,) = x, ordinate, at energy `h`, in units of the well."""

    def __init__(self, potential: Potential, plane: Slice, h: float, centre: np.ndarray, execution: Execution) -> None:
        self.potential, self.plane, self.h, self.centre = potential, plane, h, centre
        self.execution = execution

    def classify_centre(self, t_max: float) -> None:
        """Find the fate of the centre, and set the integration time of its neighbours."""
        fate, escape_time = self.classify(self.centre[None], t_max)
        self.centre_fate = int(fate[0])
        scaled_time = _HORIZON_FACTOR * escape_time[0] if self.centre_fate >= 1 else 0.0
        self.horizon = min(t_max, max(_SHORTEST_HORIZON, scaled_time))

    def find_nearest(self, furthest: float) -> DivergentStart | None:
        """Find the nearest divergent start up to the distance `furthest`; None if there is none."""
        directions = _search_directions(self.plane)
        # The batches of rings are classified one by one, up to the first with a divergent start.
        brackets = (self.find_bracket(radii, directions) for radii in _ring_radii(furthest, len(directions)))
        bracket = next(filter(None, brackets), None)
        if bracket is None:
            return None
        # Below the smallest distance, rounding would decide.
        refinements = _REFINEMENTS if bracket.high > _MIN_DISTANCE else 0
        for _ in range(refinements):
            radii = np.linspace(bracket.low, bracket.high, _SECTIONS + 1)
            # The last of these rings has a divergent start, so `or` only excludes None for the type checker.
            bracket = self.find_bracket(radii, bracket.directions) or bracket
        x, ordinate = (self.centre + bracket.high * bracket.directions[0]).tolist()
        distance = float(np.hypot(*(self.centre - [x, ordinate])))
        return DivergentStart(x, ordinate, distance, int(bracket.fates[0]), self.centre_fate, self.potential.outcomes_at(self.h))

    def find_bracket(self, radii: np.ndarray, directions: np.ndarray) -> _Bracket | None:
        """Return the bracket of the smallest of increasing radii with a divergent start; None if there is none.

        The first radius is not classified: it has no divergent start.
        """
        fate = self.classify(self.centre + radii[1:, None, None] * directions, self.horizon)[0]
        divergent = (fate >= 1) & (fate != self.centre_fate)
        if not divergent.any():
            return None
        ring = int(np.argmax(divergent.any(axis=1)))
        is_divergent = divergent[ring]
        return _Bracket(float(radii[ring]), float(radii[ring + 1]), directions[is_divergent], fate[ring, is_divergent])

    def classify(self, points: np.ndarray, t_max: float) -> tuple[np.ndarray, np.ndarray]:
        """Return fates and escape times, (…) each, of points (…, 2); points without a state are forbidden."""
        x, ordinate = points.reshape(-1, 2).T
        states = self.plane.states(self.potential, self.h, x, ordinate)
        energies = np.where(np.isfinite(states).all(axis=1), self.h, np.nan)
        outcomes = classify_in_well_units(self.potential, energies, states, t_max, self.execution)
        self.execution.raise_if_cancelled()
        return outcomes.fate.reshape(points.shape[:-1]), outcomes.escape_time.reshape(points.shape[:-1])


def _search_directions(plane: Slice) -> np.ndarray:
    """Return unit vectors, (m, 2); with an axis h, the two directions of constant energy."""
    if not all(plane.free_axes):
        direction = np.array(plane.free_axes, float)
        return np.array([direction, -direction])
    angle = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    # The vectors are rounded, so that the neighbours of mirror images are exact mirror images.
    return np.round(np.column_stack([np.cos(angle), np.sin(angle)]), 12)


def _ring_radii(furthest: float, direction_count: int) -> Iterator[np.ndarray]:
    """Yield batches of increasing radii, from 0 and then spaced logarithmically.

    Each batch begins with the last radius of the previous batch.
    """
    count = int(np.ceil(_STARTS_PER_DECADE / direction_count * np.log10(furthest / _MIN_DISTANCE))) + 1
    radii = np.concatenate([[0.0], np.geomspace(_MIN_DISTANCE, furthest, count)])
    rings_per_batch = _BATCH_SIZE // direction_count
    yield from (radii[begin : begin + rings_per_batch + 1] for begin in range(0, count, rings_per_batch))
