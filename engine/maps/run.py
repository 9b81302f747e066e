"""Computation of one map in stages: coarse to fine, short to long integration times, with tests for evidence in between."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from engine.evidence.bounded_orbits import BoundedOrbitSearch
from engine.exits.exit_rows import closed_exits, exit_curves
from engine.foundations.execution import Execution, run_parts
from engine.maps.pixels import MirrorPixels
from engine.maps.result import EscapeMap, collect_map, find_interior, representative_indices
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch
from engine.propagation.classification import Outcomes, collect_outcomes
from engine.propagation.fates import Evidence, Fate

COARSE_PIXELS = 1200
"""Largest number of pixels in the first frame."""

FIRST_TEST_TIME = 1000.0
"""Time, in units of the well, at which undecided orbits are first tested for evidence. Most escapes happen earlier."""

# Horizon of the first stages, in units of the well.
_FIRST_HORIZON = 100.0
# Ratio of successive horizons.
_HORIZON_FACTOR = 10.0


def rising_horizons(first: float, factor: float, t_max: float) -> Iterator[float]:
    """Yield the integration times of successive stages: a geometric sequence below t_max, then t_max."""
    horizon = first
    while horizon < t_max:
        yield horizon
        horizon *= factor
    yield t_max


def looks_for_tori(spec: MapSpec) -> bool:
    """Return whether the orbits of a map are tested for evidence of tori."""
    return spec.use_evidence and spec.potential.tori_are_evidence


class MapRun:
    """Computes a map, or some of its rows, in units of the well.

    If two pixels are mirror images of each other, only the first is computed. The results up to a time do not depend on t_max, so
    a map can be continued to a larger t_max. Stages end at fixed times. At these times, starting with `FIRST_TEST_TIME`, orbits
    that are still inside are tested for evidence.

    Parameters
    ----------
    spec
        The request, `MapSpec.in_well_units`.
    resume
        An earlier map in units of the well, with its integration state, to continue from.
    rows
        Increasing row numbers; None for all rows.
    coarse_first
        Whether to start with coarse stages, whose frames give an early overview.

    Attributes
    ----------
    spec
        The request.
    stride, horizon
        Stride and horizon of the current stage, see `EscapeMap`.
    """

    def __init__(
        self, spec: MapSpec, resume: EscapeMap | None = None, rows: np.ndarray | None = None, *, coarse_first: bool = True
    ) -> None:
        self.spec = spec
        self.x, ordinate = spec.pixel_centres()
        self.ordinate = ordinate if rows is None else ordinate[rows]
        self.shape = (self.ordinate.size, self.x.size)
        self.stride = _coarsest_stride(self.shape) if coarse_first else 1
        self.horizon = min(_FIRST_HORIZON, spec.t_max)
        self._mirror = MirrorPixels(spec, self.x, self.ordinate)
        self._section = spec.section.numbers
        rows_of_pixels, columns_of_pixels = np.divmod(np.arange(self.ordinate.size * self.x.size), self.x.size)
        self._energy = spec.energies(self.x[columns_of_pixels], self.ordinate[rows_of_pixels])
        # With an axis h, each row or column of pixels has its own energy, and its own exits in a row of `_curves`.
        self._curve_row = spec.plane.energy_groups(*self.shape)
        self._curves = np.repeat(closed_exits(spec.potential)[None], self._curve_row[-1] + 1, axis=0)
        self._rows_without_exits = set(range(len(self._curves)))
        self._batch, self._started = OrbitBatch.empty(self._curve_row), np.zeros(self._curve_row.size, bool)
        # Energy errors of orbits that an earlier map has finished, because their states are not stored; NaN for other orbits.
        self._earlier_errors: np.ndarray | None = None
        if resume is not None:
            self._continue_from(resume)

    def _continue_from(self, earlier: EscapeMap) -> None:
        """Copy the outcomes of an earlier map, and the states of the orbits that a larger t_max can change."""
        assert earlier.batch is not None
        continued_pixels = earlier.continued_pixels
        self._started = earlier.started.ravel().copy()
        self._earlier_errors = earlier.energy_error.ravel().copy()
        self._earlier_errors[continued_pixels] = np.nan
        self._batch.set_outcomes(
            earlier.fate.ravel(), earlier.escape_time.ravel(), earlier.crossings.ravel(),
            earlier.outside.ravel(), earlier.evidence.ravel(),
        )  # fmt: skip
        self._batch.put(continued_pixels, earlier.batch)
        self._batch.reopen(continued_pixels)

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage integrates orbits to a horizon, or looks for evidence there."""
        on_pixels = partial(on_change, False)
        self._find_starts(execution)
        for pixels, stride, horizon in self._targets():
            # Here, `self.horizon` is the horizon of the preceding stage.
            if looks_for_tori(self.spec) and self.horizon >= FIRST_TEST_TIME:
                yield partial(self._test_for_evidence, self.horizon, execution, on_pixels)
            yield partial(self._advance, pixels, stride, horizon, execution, on_pixels)

    def _targets(self) -> Iterator[tuple[np.ndarray, int, float]]:
        """Yield (pixels, stride, horizon): every refinement at the shortest horizon, then all pixels at longer horizons."""
        first_horizon, *later_horizons = rising_horizons(_FIRST_HORIZON, _HORIZON_FACTOR, self.spec.t_max)
        for pixels, stride in self._refinements():
            yield pixels, stride, first_horizon
        # After the loop, `pixels` and `stride` are those of the last refinement.
        for horizon in later_horizons:
            yield pixels, stride, horizon

    def _refinements(self) -> Iterator[tuple[np.ndarray, int]]:
        """Yield (pixels, stride) of each refinement, coarse to fine. The last refinement contains all pixels."""
        pixel_numbers = np.arange(self._started.size).reshape(self.shape)
        stride = 1 if self._started.all() else self.stride
        while stride > 1:
            rows, columns = (np.unique(representative_indices(size, stride)) for size in self.shape)
            yield self._mirror.find_first_images(pixel_numbers[np.ix_(rows, columns)].ravel()), stride
            stride //= 2
        yield self._mirror.find_first_images(pixel_numbers.ravel()), 1

    def _find_starts(self, execution: Execution) -> None:
        """Find the initial states of all pixels that have not been started, except second mirror images."""
        not_started = np.flatnonzero((self._batch.fate == Fate.NOT_COMPUTED) & ~self._started)
        first_images = self._mirror.select_first_images(not_started)
        grid = self.spec, self.x, self.ordinate
        for part, states in run_parts(_start_states, first_images, lambda part: (*grid, part), execution=execution):
            self._batch.set_starts(part, states)

    def _advance(
        self, pixels: np.ndarray, stride: int, horizon: float, execution: Execution, on_tiles: Callable[[], None]
    ) -> None:
        """Integrate the orbits of some pixels to a horizon."""
        self._begin_stage(pixels, stride, horizon, execution)
        propagate_batch(
            self.spec.potential, self._curves, self._batch, pixels[self._started[pixels]], horizon,
            final=horizon == self.spec.t_max, execution=execution, on_tiles=on_tiles, section=self._section,
        )  # fmt: skip

    def _begin_stage(self, pixels: np.ndarray, stride: int, horizon: float, execution: Execution) -> None:
        """Set stride and horizon, find the exits that the pixels need, and start those pixels that have not been started."""
        self.stride, self.horizon = stride, horizon
        self._find_exits(pixels)
        new_pixels = pixels[~self._started[pixels]]
        started_pixels = self._batch.mark_outside(self.spec.potential, new_pixels, self._curves, execution=execution)
        self._started[started_pixels] = True
        if self.spec.use_evidence:
            self._mark_closed(pixels[self._started[pixels]])

    def _mark_closed(self, pixels: np.ndarray) -> None:
        """Mark undecided orbits in a closed well, see `Well.is_closed_at`, as bounded without integration."""
        is_closed = self.spec.potential.well.is_closed_at(self._energy[pixels])
        is_undecided = self._batch.fate[pixels] == Fate.NOT_COMPUTED
        self._batch.mark_bounded(pixels[is_closed & is_undecided], Evidence.CLOSED)

    def _find_exits(self, pixels: np.ndarray) -> None:
        """Find the exits at the energies of the pixels, except where they are known."""
        if not self._rows_without_exits:
            return
        # One pixel of each energy.
        rows, first_indices = np.unique(self._curve_row[pixels], return_index=True)
        for row, pixel in zip(rows.tolist(), pixels[first_indices], strict=True):
            if row in self._rows_without_exits:
                self._curves[row] = exit_curves(self.spec.potential, float(self._energy[pixel]))
                self._rows_without_exits.discard(row)

    def _test_for_evidence(self, time: float, execution: Execution, on_round: Callable[[], None]) -> None:
        """Mark orbits that are inside at t = `time` as bounded if there is evidence. A cancelled test marks no orbits."""
        spec, batch = self.spec, self._batch
        tested_pixels = self._find_untested(time, execution)
        if not tested_pixels.size:
            return
        grid_indices = np.column_stack(np.divmod(tested_pixels, self.shape[1]))
        # The time until the next horizon. The test at the preceding horizon had a time shorter by `_HORIZON_FACTOR`.
        time_left = (_HORIZON_FACTOR - 1.0) * time
        search = BoundedOrbitSearch(
            spec.potential, spec.common_energy, batch.state[tested_pixels], grid_indices, time_left, execution,
            tested_for=time_left / _HORIZON_FACTOR, digits=batch.digits[tested_pixels],
        )  # fmt: skip

        def mark_bounded() -> None:
            batch.mark_bounded(tested_pixels, search.evidence)
            on_round()

        if search.run(mark_bounded):
            batch.tested[tested_pixels], batch.digits[tested_pixels] = time, search.digits
        else:
            # When the map is continued, the test is repeated with all these orbits, so that its result is the same.
            batch.reopen(tested_pixels)

    def _find_untested(self, time: float, execution: Execution) -> np.ndarray:
        """Return the pixels whose orbits are inside at t = `time` and have not been tested at that time."""
        batch = self._batch
        untested = np.flatnonzero((batch.fate == Fate.NOT_COMPUTED) & (batch.tested < time))
        first_images = self._mirror.select_first_images(untested)
        # Orbits stop before the step across `time`. On a map with t_max = `time`, an orbit can escape in this step, so the step
        # is also taken here.
        propagate_batch(
            self.spec.potential, self._curves, batch, first_images, time,
            final=True, execution=execution, section=self._section,
        )  # fmt: skip
        inside: np.ndarray = first_images[batch.fate[first_images] == Fate.BOUNDED]
        batch.reopen(inside)
        return inside

    def result(self) -> EscapeMap:
        """Return the map so far, with the integration state for a later `resume`."""
        frame = self.frame()
        return replace(frame, batch=self._batch.take(frame.continued_pixels))

    def frame(self) -> EscapeMap:
        """Return the map so far."""
        self._copy_to_second_images()
        batch, outcomes = self._batch, self._collect_outcomes()
        arrays = {name: getattr(outcomes, name) for name in ("fate", "escape_time", "crossings", "energy_error")}
        arrays |= {"evidence": batch.final_evidence(), "outside": batch.outside.copy(), "started": self._started.copy()}
        stage = {"stride": self.stride, "horizon": self.horizon, "progress": self.progress()}
        return collect_map(self.spec, (self.x, self.ordinate), arrays, **stage)

    def _copy_to_second_images(self) -> None:
        """Copy the outcomes of started pixels to their second mirror images."""
        partner = self._mirror.partner
        first_images = np.flatnonzero(self._started & (partner > np.arange(partner.size)))
        if first_images.size:
            mirror_numbers = self.spec.potential.well.mirror_numbers(self._energy[first_images])
            self._batch.copy_to_images(first_images, partner[first_images], mirror_numbers)
            self._started[partner[first_images]] = True

    def _collect_outcomes(self) -> Outcomes:
        """Return the outcomes of all pixels, arrays of shape (n,)."""
        outcomes = collect_outcomes(self.spec.potential, self._energy, self._batch)
        if self._earlier_errors is None:
            return outcomes
        errors = np.where(np.isnan(self._earlier_errors), outcomes.energy_error, self._earlier_errors)
        return replace(outcomes, energy_error=errors)

    def progress(self) -> float:
        """Return the share of the work done: the time covered, as a share of t_max, averaged over the interior pixels."""
        fate = self._batch.fate
        shares = np.where(fate == Fate.NOT_COMPUTED, np.minimum(self._batch.t / self.spec.t_max, 1.0), 1.0)
        # Second mirror images do not count, because they are copied later.
        is_counted = find_interior(fate) & (self._mirror.partner >= np.arange(fate.size))
        return float(shares[is_counted].mean()) if is_counted.any() else 1.0


def _start_states(spec: MapSpec, x: np.ndarray, ordinate: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Return the initial states of n pixels of a map with these pixel centres, of shape (n, 4). A worker calls this."""
    rows, columns = np.divmod(pixels, x.size)
    return spec.start_states(x[columns], ordinate[rows])


def _coarsest_stride(shape: tuple[int, int]) -> int:
    """Return the smallest power of 2 for which there are at most `COARSE_PIXELS` squares of this side."""
    stride = 1
    while math.ceil(shape[0] / stride) * math.ceil(shape[1] / stride) > COARSE_PIXELS:
        stride *= 2
    return stride
