"""Reliability of map pixels: whether an outcome survives a tiny shift of the start and a different step tolerance."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from typing import ClassVar

import numpy as np

from engine.evidence.bounded_orbits import BoundedOrbitSearch
from engine.exits.exit_rows import exit_curves_at
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_share
from engine.integrator.kernels.dense_output import advance_states
from engine.maps.analyses.map_analysis import analyse_map
from engine.maps.analyses.reruns import SHIFT, SHIFTED_STARTS, Perturbation, Rerun
from engine.maps.parameter_map import Place
from engine.maps.pixels import PixelAnalysis, PixelCodes, code_share
from engine.maps.result import EscapeMap, MapLike, as_complete_map
from engine.maps.run import FIRST_TEST_TIME, looks_for_tori, rising_horizons
from engine.maps.stages import OnChange, Stage
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.propagation.fates import CHAOS_THRESHOLD, Evidence, Fate

CHAOTIC_DISTANCE = SHIFT / CHAOS_THRESHOLD
"""Distance of two reruns in phase space, in units of the well, above which a bounded orbit is chaotic.

Along a chaotic orbit SALI falls as exp(−λt) while a shift grows as exp(λt): the shift reaches this distance when SALI reaches its
threshold. Along a regular orbit a shift grows like t, to about 1e-6 at t = 1e5.
"""

# Horizon of the first stage, in units of the well. With the following factor, FIRST_TEST_TIME is one of the horizons.
_FIRST_HORIZON = FIRST_TEST_TIME / 8.0
# Ratio of successive horizons. A small ratio integrates few orbits longer than needed.
_HORIZON_FACTOR = 2.0
# A grid index on the coarsest lattice of `BoundedOrbitSearch`. The bounded pixels to test are few and lie around islands, so one
# round with all of these pixels fills the lanes of the kernels better than one round per lattice.
_COARSEST_LATTICE_INDEX = 8


class Trust(IntEnum):
    """Whether the outcome of a pixel is robust against small changes.

    ``NOT_APPLICABLE``: the start is forbidden or outside, or the orbit failed. ``LIKE_NEIGHBOURS``: not tested, because all
    neighbours have the same outcome, and the orbit escapes or is bounded on evidence. ``CONFIRMED``: tested and unchanged.
    ``DOUBTFUL``: the fate, the number of crossings before the escape or the escape time changed, or the orbit is bounded only by
    chance. ``NOT_TESTED``: not computed yet.
    """

    NOT_APPLICABLE = 0
    LIKE_NEIGHBOURS = 1
    CONFIRMED = 2
    DOUBTFUL = 3
    NOT_TESTED = 4

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")


@dataclass(frozen=True, eq=False, repr=False)
class TrustMap(PixelAnalysis):
    """Reliability of the pixels of a map, complete or in progress.

    Attributes
    ----------
    spec
        The map's request.
    trust
        (rows, columns) int8 `Trust` codes, read-only.
    complete
        Whether all pixels that need a test have been tested.
    """

    trust: np.ndarray
    codes: ClassVar = {"trust": Trust}
    pixel_arrays: ClassVar = {"trust": (np.int8, Trust.NOT_APPLICABLE)}

    @property
    def doubtful_share(self) -> float:
        """Share of doubtful pixels among the interior pixels; NaN if there are none."""
        return self._share(Trust.DOUBTFUL)

    @property
    def tested_share(self) -> float:
        """Share of the pixels tested so far among the interior pixels; NaN if there are none."""
        return self._share(Trust.CONFIRMED, Trust.DOUBTFUL)

    def describe(self) -> str:
        """Return the shares in one sentence."""
        if np.isnan(self.doubtful_share):
            return "There are no pixels inside to test."
        doubtful, tested = (format_share(share, 2) for share in (self.doubtful_share, self.tested_share))
        so_far = "" if self.complete else " so far"
        return f"Of the pixels inside, {tested} were tested{so_far} and {doubtful} are doubtful."

    def _share(self, *codes: Trust) -> float:
        """Return the share of the pixels with these codes among the interior pixels."""
        return code_share(self.trust[self.trust != Trust.NOT_APPLICABLE], *codes)


@shows_progress("trust")
@checks_types(on_frame=(Callable, type(None)), execution=Execution)
def compute_trust(
    escape_map: MapLike,
    *,
    on_frame: Callable[[TrustMap], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> TrustMap:
    """Find the pixels of a complete map whose outcome changes under a perturbation far smaller than a pixel.

    A pixel is tested if one of its eight neighbours has another fate, or the same exit but another number of crossings, and also
    if the pixel is bounded without evidence. Its orbit is integrated twice more, from two starts shifted in different directions
    by 1e-11 length units of the well, but at most a hundredth of a pixel. The second rerun has ten times the tolerance. The pixel
    is doubtful if a rerun changes the fate or the crossings before the escape, or changes the escape time by more than 0.01 time
    units of the well. Crossings of bounded orbits are not compared, because orbits that are bounded on evidence are not
    integrated to t_max.

    A pixel that is bounded without evidence is also doubtful if the distance of the two reruns in phase space exceeds 1e-4. Such
    an orbit is chaotic, and only chance keeps it inside until t_max. If two pixels are mirror images, only the first is tested.

    Parameters
    ----------
    escape_map
        A complete map, or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep.
    on_frame
        Called in this thread with the result so far.
    execution
        How the computation runs. When it is cancelled, pixels whose test is not finished stay `Trust.NOT_TESTED`.

    Raises
    ------
    ValueError
        When the map is not complete.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_trust
    >>> trust = compute_trust(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 40), t_max=1e3)))
    >>> round(trust.tested_share, 2), round(trust.doubtful_share, 2)
    (0.54, 0.03)
    """
    escape_map = as_complete_map("escape_map", escape_map)
    has_unlike_neighbour = find_unlike_neighbours(escape_map.fate, escape_map.crossings)

    def begin_test(pixels: EscapeMap, place: Place) -> TrustTest:
        return TrustTest(pixels, has_unlike_neighbour[place], SHIFTED_STARTS)

    return analyse_map(escape_map, begin_test, TrustMap, on_frame, execution)


def find_unlike_neighbours(fate: np.ndarray, crossings: np.ndarray) -> np.ndarray:
    """Find the interior pixels that have, among their eight neighbours, an interior pixel with a different outcome.

    Outcomes differ if the fates differ or, for escaping orbits, the crossings.

    Parameters
    ----------
    fate, crossings
        (rows, columns) as in `EscapeMap`.

    Returns
    -------
    (rows, columns) bool.
    """
    # One number for each outcome: for escaping orbits, of the fate and the number of crossings.
    outcome = np.where(fate >= 1, crossings.astype(np.int64) * (int(fate.max(initial=0)) + 1) + fate, 0)
    interior = fate >= Fate.BOUNDED
    rows, columns = fate.shape
    has_unlike_neighbour = np.zeros(fate.shape, bool)
    padded_outcome, padded_interior = np.pad(outcome, 1), np.pad(interior, 1)
    for down, right in np.ndindex(3, 3):
        neighbour = np.s_[down : down + rows, right : right + columns]
        has_unlike_neighbour |= padded_interior[neighbour] & (padded_outcome[neighbour] != outcome)
    return has_unlike_neighbour & interior


def _is_bounded_without_evidence(escape_map: EscapeMap) -> np.ndarray:
    """Return whether each pixel is bounded, above the escape energy, without evidence, of shape (rows, columns)."""
    spec = escape_map.spec
    energy = spec.energies(*np.meshgrid(escape_map.x, escape_map.ordinate))
    return (escape_map.evidence == Evidence.INTEGRATED) & ~spec.potential.well.is_closed_at(energy)


class TrustTest:
    """Tests pixels of a map by reruns, in units of the well. `has_unlike_neighbour` is the result of `find_unlike_neighbours`."""

    def __init__(self, escape_map: EscapeMap, has_unlike_neighbour: np.ndarray, perturbation: Perturbation) -> None:
        self._given_spec, scaled_map = escape_map.spec, escape_map.in_well_units()
        self.spec = scaled_map.spec
        codes = np.where(scaled_map.fate >= Fate.BOUNDED, Trust.LIKE_NEIGHBOURS, Trust.NOT_APPLICABLE)
        without_evidence = _is_bounded_without_evidence(scaled_map)
        codes[without_evidence | has_unlike_neighbour] = Trust.NOT_TESTED
        self._codes = PixelCodes(scaled_map, codes, Trust.NOT_TESTED)
        # Whether each tested pixel is bounded without evidence. It is doubtful if its reruns separate.
        self._without_evidence = without_evidence.ravel()[self._codes.pixels]
        # Whether the reruns of each tested pixel have separated.
        self._chaotic = np.zeros(self._codes.pixels.size, bool)
        # Time up to which the reruns have been compared.
        self._compared_time = 0.0
        # Indices of undecided pixels in the arrays of the reruns.
        self._undecided = np.arange(self._codes.pixels.size)
        self._curves, self._reruns = self._prepare_reruns(scaled_map, perturbation)

    def _prepare_reruns(self, escape_map: EscapeMap, perturbation: Perturbation) -> tuple[np.ndarray, list[Rerun]]:
        """Return the exit curves of each energy, and the reruns at t = 0."""
        spec, potential, pixels = self.spec, self.spec.potential, self._codes.pixels
        x, ordinate = escape_map.coordinates(pixels)
        fate, crossings, escape_time = (
            getattr(escape_map, name).ravel()[pixels] for name in ("fate", "crossings", "escape_time")
        )
        energies, curve_row = np.unique(spec.energies(x, ordinate), return_inverse=True)
        curves = exit_curves_at(potential, energies)
        # Orbits in a closed well are bounded without integration.
        closed = np.flatnonzero(potential.well.is_closed_at(energies[curve_row]))
        reruns = []
        for start, tolerance in zip(perturbation.find_starts(spec, x, ordinate), perturbation.tolerances, strict=True):
            batch = OrbitBatch.from_starts(spec.start_states(*start), curve_row)
            batch.mark_outside(potential, self._undecided, curves)
            batch.mark_bounded(closed[batch.fate[closed] == Fate.NOT_COMPUTED], Evidence.CLOSED)
            reruns.append(Rerun(batch, tolerance, perturbation.largest_delay, fate, crossings, escape_time))
        return curves, reruns

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage integrates undecided reruns to a horizon, or looks for evidence there."""
        reached_time = 0.0
        for horizon in rising_horizons(_FIRST_HORIZON, _HORIZON_FACTOR, self.spec.t_max):
            if not self._undecided.size:
                return
            if looks_for_tori(self.spec) and reached_time == FIRST_TEST_TIME:
                yield partial(self._find_evidence, reached_time, execution, partial(on_change, False))
            yield partial(self._propagate, horizon, execution)
            reached_time = horizon

    def _propagate(self, horizon: float, execution: Execution) -> None:
        """Integrate the reruns of all undecided pixels to the horizon."""
        # The reruns are concurrent, because one alone may not keep all workers busy. Their threads mostly wait for tiles.
        with ThreadPoolExecutor(len(self._reruns)) as threads:
            list(threads.map(partial(self._propagate_rerun, horizon, execution), self._reruns))
        self._update_codes()
        if not execution.is_cancelled:
            self._find_chaotic(horizon)
            self._update_codes()

    def _propagate_rerun(self, horizon: float, execution: Execution, rerun: Rerun) -> None:
        """Integrate the undecided orbits of one rerun to the horizon."""
        propagate_batch(
            self.spec.potential, self._curves, rerun.batch, self._undecided, horizon,
            final=horizon == self.spec.t_max, tolerance=rerun.tolerance, execution=execution, section=self.spec.section.numbers,
        )  # fmt: skip

    def _find_chaotic(self, time: float) -> None:
        """Find pixels bounded without evidence whose reruns are farther apart than `CHAOTIC_DISTANCE` at t = `time`."""
        tested = self._undecided[self._without_evidence[self._undecided]]
        kernels = self.spec.potential.well.kernels
        batches = [rerun.batch for rerun in self._reruns]
        # A single rerun is compared with itself, and therefore finds no chaos.
        states = np.array([advance_states(kernels, batch.state[tested], time - batch.t[tested]) for batch in batches])
        self._chaotic[tested] = np.linalg.norm(states[0] - states[-1], axis=1) > CHAOTIC_DISTANCE
        self._compared_time = time

    def _find_evidence(self, time: float, execution: Execution, on_round: Callable[[], None]) -> None:
        """Mark reruns of pixels that are bounded on the map as bounded if their states at t = `time` give evidence.

        Evidence for the first rerun holds for both reruns, because on a regular orbit their difference is far below the digits
        that are compared.
        """
        first, undecided = self._reruns[0], self._undecided
        tested = undecided[(first.fate[undecided] == Fate.BOUNDED) & ~first.is_decided()[undecided]]
        if not tested.size:
            return
        grid_indices = np.full((tested.size, 2), _COARSEST_LATTICE_INDEX)
        search = BoundedOrbitSearch(
            self.spec.potential, self.spec.common_energy, first.batch.state[tested], grid_indices, self.spec.t_max - time,
            execution=execution,
        )  # fmt: skip

        def mark_bounded() -> None:
            for rerun in self._reruns:
                pending = ~rerun.is_decided()[tested]
                rerun.batch.mark_bounded(tested[pending], search.evidence[pending])
            self._update_codes()
            on_round()

        search.run(mark_bounded)

    def _update_codes(self) -> None:
        """Assign the codes of decided pixels, and find the undecided pixels."""
        is_decided = np.all([rerun.is_decided() for rerun in self._reruns], axis=0)
        has_changed = np.any([rerun.has_changed() for rerun in self._reruns], axis=0) | self._chaotic
        if self._compared_time < self.spec.t_max:
            # Pixels without evidence are decided when their reruns have been compared at t_max.
            is_decided &= ~self._without_evidence | (self._reruns[0].batch.evidence != Evidence.NONE)
        # A pixel that is decided and has changed becomes doubtful.
        self._codes.assign(self._codes.pixels[is_decided], Trust.CONFIRMED)
        self._codes.assign(self._codes.pixels[has_changed], Trust.DOUBTFUL)
        self._undecided = np.flatnonzero(~is_decided & ~has_changed)

    def progress(self) -> float:
        """Return the share of the pixels that are decided."""
        return 1.0 - self._undecided.size / max(self._codes.pixels.size, 1)

    def frame(self) -> TrustMap:
        """Return the result so far."""
        codes, complete = self._codes.snapshot()
        return TrustMap(self._given_spec, codes, complete=complete)
