"""Uncertainty exponent of exit basins from random pairs of starts, at separations far below a pixel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.exits.exit_rows import exit_curves_at
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import RandomNumbers, checked_count, checked_seed, checked_t_max, checks_types
from engine.maps.spec import MapSpec
from engine.measures.basins.power_law_fit import MIN_EXPECTED_PAIRS, UncertaintyExponent, fit_uncertainty, predict_shares
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.propagation.fates import Evidence, Fate

HORIZON = 1e4
"""Longest integration time of the pairs, in units of the well.

Integration to t = 1e5 changed the exponents of I (h = 0.15), II (0.17) and III (0.45) only within their intervals. Integration to
t = 1000 made the exponent of I at h = 0.15 too large by 0.02, because a slowly leaking chaotic sea then looks like an island.
"""

MIN_SEPARATION = 1e-10
"""Smallest distance of two starts, in units of the well. Deep zooms, with small pixels, use smaller distances."""

WORK = 1.5e8
"""Default limit of the total integration time of all orbits, in units of the well: a few seconds of computation."""

# Number of decades from the smallest separation to a pixel in a deep zoom.
_DECADES_BELOW_PIXEL = 4.0
# Lower limit of all separations, in units of the well: a few hundred units in the last place of coordinates of order 1.
_MIN_ZOOM_SEPARATION = 1e-13
# Largest number of separations.
_MAX_SEPARATIONS = 100
# Largest integration time of all orbits, thousands of times the default.
_MOST_WORK = 1e12
# Largest initial number of pairs at each separation.
_MAX_PAIRS = 100_000
# Desired number of uncertain pairs at each separation. They determine a share to 7 %. The law fitted to the initial pairs
# predicts how many pairs this takes.
_TARGET_UNCERTAIN_PAIRS = 200
# Largest ratio of the final to the initial number of pairs. The total integration time also limits the number of pairs.
_MAX_GROWTH = 2000
# Cost of a pair in addition to its integration, as an integration time in units of the well.
_PAIR_COST = 20.0
# Number of pairs drawn and integrated together.
_PAIRS_PER_CHUNK = 2**17
# Times at which the integration stops, to regroup the few remaining orbits, in units of the well.
_REGROUP_TIMES = (30.0, 300.0)
# Smallest share of interior points among the points drawn in the window. Drawing stops if there are fewer.
_MIN_YIELD = 1e-3


@shows_progress("uncertainty exponent")
@checks_types(spec=MapSpec, execution=Execution)
def compute_uncertainty_exponent(
    spec: MapSpec,
    *,
    pairs: int = 200,
    separations: int = 17,
    work: float = WORK,
    rng: RandomNumbers = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> UncertaintyExponent:
    """Measure how fast the share of uncertain starts falls with the error ε of a start, and thereby the boundary dimension.

    A start is ε-uncertain if a start at distance ε has a different fate. The share of such starts falls as f(ε) ~ ε^α, and the
    basin boundary has dimension 2 − α in the plane of initial conditions (Grebogi, McDonald, Ott & Yorke 1983, Phys. Lett. A 99,
    415; McDonald, Grebogi, Ott & Yorke 1985, Physica D 17, 125). Each ε has its own random pairs: the first start is uniform over
    the interior of the window, and the second lies at distance ε in a random direction of the plane. On (x, h) both starts have
    the energy of a row of pixels, and the second start is displaced along x. Pairs with a forbidden or outside start are drawn
    again.

    Orbits are integrated to t_max, at most 1e4 time units of the well. Orbits still inside at that time have a fate of their own.
    In the result, `one_inside` and `both_inside` count the pairs that this choice can affect. The number of pairs in which both
    orbits escape is ``pairs − one_inside − both_inside``; ``uncertain − one_inside`` of these pairs are uncertain.

    Separations with few uncertain pairs get more pairs, as many as the law fitted to the first pairs suggests, within a fixed
    total integration time.

    Parameters
    ----------
    spec
        Plane, energy, window, direction of time and t_max. The largest ε is the shorter side of a pixel. The smallest ε is 1e-10
        length units of the well or, in a deep zoom, four decades below a pixel, but not below 1e-13 units. Momenta are measured
        in units in which the unit of time of the well is 1.
    pairs
        Initial number of pairs at each separation, 10 to 100 000.
    separations
        Number of values of ε, evenly spaced on a logarithmic scale, 5 to 100.
    work
        Limit of the total integration time of all orbits, above 0 and at most 1e12, in time units of the well. The initial pairs
        are always integrated.
    rng
        Random numbers: a seed, 0 to 2⁶³ − 1, of which equal ones give equal results, or a NumPy generator; None for new numbers.
    execution
        How the computation runs.

    Returns
    -------
    The `UncertaintyExponent`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If a parameter is out of range, or the pixels are too small to resolve starts inside a pixel.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_uncertainty_exponent
    >>> result = compute_uncertainty_exponent(MapSpec(CASES["II"], Plane.X_PX, 0.25), work=1e6, rng=0)
    >>> round(result.low, 2), round(result.exponent, 2), round(result.high, 2)
    (0.21, 0.23, 0.25)
    """
    spec.plane.check_one_potential("spec")
    pairs = checked_count("pairs", pairs, 10, _MAX_PAIRS)
    separations = checked_count("separations", separations, 5, _MAX_SEPARATIONS)
    seed = checked_seed(rng)
    work = checked_t_max(work, _MOST_WORK, name="work")
    units = spec.potential.units
    sampler = _PairSampler(spec.in_well_units(), _space_separations(spec, separations), seed, execution)
    sampler.sample(np.full(separations, pairs), execution.part(0, 2))
    sampler.sample(sampler.plan_more_pairs(work), execution.part(1, 2))
    execution.report(lambda: 1.0)
    fit = sampler.fit()
    amplitude = fit.amplitude / units.length**fit.exponent
    return replace(units.restore(fit), amplitude=amplitude, made_by=spec.provenance())


def _space_separations(spec: MapSpec, count: int) -> np.ndarray:
    """Return `count` separations ε in units of the well, decreasing from the side of a pixel."""
    scaled_spec = spec.in_well_units()
    window, (columns, rows) = scaled_spec.find_window(), spec.resolution
    sides = window.width / columns, window.height / rows
    pixel = min(side for side, is_free in zip(sides, scaled_spec.plane.free_axes, strict=True) if is_free)
    smallest = max(min(MIN_SEPARATION, pixel * 10.0**-_DECADES_BELOW_PIXEL), _MIN_ZOOM_SEPARATION)
    if pixel < 100.0 * smallest:
        raise ValueError(
            f"window={spec.find_window()}: pixels of {pixel:.0e} units of the well are too small for double precision; "
            f"must be {100.0 * smallest:.0e} or more"
        )
    return np.geomspace(pixel, smallest, count)


class _PairSampler:
    """Draws and integrates pairs of starts, and counts their outcomes at each of m separations, in units of the well."""

    def __init__(self, spec: MapSpec, separations: np.ndarray, seed: int, execution: Execution) -> None:
        self.spec, self.separations, self.execution = spec, separations, execution
        self.horizon = min(spec.t_max, HORIZON)
        # Each separation has its own generator, so that its pairs do not depend on the other separations.
        self.random = [np.random.default_rng([seed, index]) for index in range(separations.size)]
        self.pairs, self.uncertain, self.one_inside, self.both_inside = np.zeros((4, separations.size), np.int64)
        self.integrated_time = 0.0
        # The energies of the pairs: the common energy, or the energies of the pixels along an axis h.
        axis = spec.plane.energy_axis
        self.row_energy = np.array([spec.common_energy]) if axis is None else spec.pixel_centres()[axis]
        self.is_open = ~spec.potential.well.is_closed_at(self.row_energy)
        self.curves = exit_curves_at(spec.potential, self.row_energy, execution)

    def plan_more_pairs(self, work: float) -> np.ndarray:
        """Return the numbers of additional pairs at each separation, (m,), within the total integration time `work`."""
        if not self.uncertain.any() or np.any(self.uncertain == self.pairs):
            return np.zeros_like(self.pairs)
        if np.count_nonzero(self.uncertain) > 1:
            share = predict_shares(self.separations, self.pairs, self.uncertain)
        else:
            # One separation does not determine a law. The law of a smooth boundary, f ~ ε, gives the largest number of pairs.
            share = self.uncertain.max() / self.pairs.max() * self.separations / self.separations[0]
        most_pairs = _MAX_GROWTH * self.pairs
        counts = np.clip(_TARGET_UNCERTAIN_PAIRS / share, self.pairs, most_pairs) - self.pairs
        # More pairs are useless if even the largest number does not make the separation count.
        counts[share * most_pairs < MIN_EXPECTED_PAIRS] = 0.0
        cost = _PAIR_COST + self.integrated_time / self.pairs.sum()
        affordable_count = max(work / cost - self.pairs.sum(), 0.0)
        return (counts * min(1.0, affordable_count / max(counts.sum(), 1.0))).astype(np.int64)

    def sample(self, counts: np.ndarray, execution: Execution) -> None:
        """Draw and integrate `counts` (m,) more pairs at each separation, and count their outcomes."""
        indices = np.repeat(np.arange(counts.size), counts)
        chunks = np.split(indices, range(_PAIRS_PER_CHUNK, indices.size, _PAIRS_PER_CHUNK)) if indices.size else []
        for number, chunk in enumerate(chunks):
            batch, separation_indices = self._draw_chunk(np.bincount(chunk, minlength=counts.size))
            self._integrate(batch, execution.part(number, len(chunks)))
            self.integrated_time += float(batch.t.sum())
            self._count_outcomes(separation_indices, *batch.fate.reshape(2, -1))

    def _draw_chunk(self, counts: np.ndarray) -> tuple[OrbitBatch, np.ndarray]:
        """Return the orbits of `counts` (m,) pairs, all first before all second starts, and the separation index of each pair."""
        present_indices = np.flatnonzero(counts)
        samples = [self._draw_pairs(index, int(counts[index])) for index in present_indices.tolist()]
        states = np.concatenate([states for states, _ in samples], axis=1).reshape(-1, 4)
        rows = np.concatenate([rows for _, rows in samples])
        batch = OrbitBatch.from_starts(states, np.tile(rows, 2))
        batch.mark_bounded(np.flatnonzero(~self.is_open[batch.curve_row]), Evidence.CLOSED)
        return batch, np.repeat(present_indices, [rows.size for _, rows in samples])

    def _integrate(self, batch: OrbitBatch, execution: Execution) -> None:
        """Integrate all orbits in stages, so that the few long orbits are grouped into full tiles."""

        def progress() -> float:
            return float(np.mean(np.where(batch.fate == Fate.NOT_COMPUTED, batch.t / self.horizon, 1.0)))

        all_orbits = np.arange(batch.fate.size)
        for horizon in (*(time for time in _REGROUP_TIMES if time < self.horizon), self.horizon):
            propagate_batch(
                self.spec.potential, self.curves, batch, all_orbits, horizon,
                final=horizon == self.horizon, execution=execution, on_tiles=lambda: execution.report(progress),
            )  # fmt: skip
            execution.raise_if_cancelled()

    def _count_outcomes(self, separation_indices: np.ndarray, first_fate: np.ndarray, second_fate: np.ndarray) -> None:
        """Count pairs, given the indices of their separations and the fates of their first and second orbits, (n,) each."""
        inside_count = (first_fate == Fate.BOUNDED).astype(int) + (second_fate == Fate.BOUNDED)
        is_decided = (first_fate >= Fate.BOUNDED) & (second_fate >= Fate.BOUNDED)
        for counts, mask in (
            (self.pairs, is_decided),
            (self.uncertain, is_decided & (first_fate != second_fate)),
            (self.one_inside, is_decided & (inside_count == 1)),
            (self.both_inside, is_decided & (inside_count == 2)),
        ):
            # This changes the array of the attribute in place.
            counts += np.bincount(separation_indices[mask], minlength=counts.size)

    def _draw_pairs(self, index: int, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the states, (2, n, 4), and energy rows, (n,), of at most `count` pairs at one separation."""
        states, rows = np.zeros((2, 0, 4)), np.zeros(0, np.int64)
        drawn_count = 0
        # Without the 10, a few unlucky first draws would end the search.
        while rows.size < count and drawn_count * _MIN_YIELD < rows.size + 10:
            self.execution.raise_if_cancelled()
            candidate_count = 2 * (count - rows.size) + 100
            more_states, more_rows = self._draw_interior_pairs(index, candidate_count)
            states, rows = np.concatenate([states, more_states], axis=1), np.concatenate([rows, more_rows])
            drawn_count += candidate_count
        return states[:, :count], rows[:count]

    def _draw_interior_pairs(self, index: int, pair_count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return states and energy rows of the interior pairs among `pair_count` random pairs in the window."""
        points, rows = self._draw_points(index, pair_count)
        batch = OrbitBatch.from_starts(self.spec.start_states(*points), np.tile(rows, 2))
        batch.mark_outside(self.spec.potential, np.arange(2 * pair_count), self.curves)
        is_interior = (batch.fate == Fate.NOT_COMPUTED).reshape(2, -1).all(axis=0)
        return batch.state.reshape(2, -1, 4)[:, is_interior], rows[is_interior]

    def _draw_points(self, index: int, pair_count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return x and ordinate of all first, then all second starts, (2, 2n), and the energy rows of the n pairs, (n,)."""
        window, random, axis = self.spec.find_window(), self.random[index], self.spec.plane.energy_axis
        rows = np.zeros(pair_count, np.int64)
        if axis is None:
            points = np.array([random.uniform(low, high, pair_count) for low, high in window.ranges])
            angle = random.uniform(0.0, 2.0 * np.pi, pair_count)
            shift = self.separations[index] * np.array([np.cos(angle), np.sin(angle)])
            return np.concatenate([points, points + shift], axis=1), rows
        # Along an axis h, points have the energies of pixels, and only the other axis is displaced.
        points, shift = np.zeros((2, pair_count)), np.zeros((2, pair_count))
        points[1 - axis] = random.uniform(*window.ranges[1 - axis], pair_count)
        rows = random.integers(0, self.row_energy.size, pair_count)
        points[axis] = self.row_energy[rows]
        # The cosine of 0 or π is a random sign.
        shift[1 - axis] = self.separations[index] * np.cos(np.pi * random.integers(0, 2, pair_count))
        return np.concatenate([points, points + shift], axis=1), rows

    def fit(self) -> UncertaintyExponent:
        """Fit the exponent to all pairs so far."""
        fit = fit_uncertainty(self.separations, self.pairs, self.uncertain)
        return replace(fit, one_inside=self.one_inside, both_inside=self.both_inside, horizon=self.horizon)
