"""Classification of the bounded orbits of a map as regular or chaotic."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar

import numpy as np

from engine.evidence.birkhoff_averages import REGULAR_DIGITS, TORUS_DIGITS, WINDOWS, count_agreeing_digits
from engine.exits.exit_rows import closed_exits, exit_curves_at
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_share
from engine.maps.analyses.map_analysis import analyse_map
from engine.maps.pixels import PixelAnalysis, PixelCodes, code_share
from engine.maps.result import EscapeMap, MapLike, as_complete_map
from engine.maps.stages import OnChange, Stage
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import JUDGEMENTS, MIN_REGULAR_TIME, Evidence, Fate, Regularity, is_chaotic
from engine.propagation.limited_steps import attach_deviations, is_energy_conserved, propagate_deviations

# Times up to which SALI is computed, with a test for tori after each, in units of the well. The SALI of strongly chaotic orbits
# falls early, and most regular orbits are found to be on a torus, so only few orbits are integrated to t_max.
_SALI_TIMES = (1000.0, 5000.0, 20000.0)
# Interval after which the remaining orbits are judged again, in units of the well.
_INTERVAL = 5000.0


@dataclass(frozen=True, eq=False, repr=False)
class RegularityMap(PixelAnalysis):
    """Character of the bounded orbits of a map, regular or chaotic, complete or in progress.

    Attributes
    ----------
    spec
        The map's request.
    character
        (rows, columns) int8 `Regularity` codes, read-only.
    sali
        (rows, columns) the smallest SALI of each bounded orbit until it was judged, 0 to √2, sampled every few units of time. It
        is at most 1e-7 for chaotic orbits and larger for others. NaN for undecided orbits, for orbits that are quasi-periodic on
        the map, and for other pixels. Read-only.
    complete
        Whether every bounded pixel is judged.
    """

    character: np.ndarray
    sali: np.ndarray
    codes: ClassVar = {"character": Regularity}
    pixel_arrays: ClassVar = {"character": (np.int8, Regularity.NOT_APPLICABLE), "sali": (np.float64, np.nan)}

    @property
    def chaotic_share(self) -> float:
        """Share of chaotic orbits among the judged bounded orbits, without undecided ones; NaN if there are none."""
        return self.share_of(Regularity.CHAOTIC)

    def describe(self) -> str:
        """Describe the share of chaotic orbits or, before the end, of orbits still to be judged, in one sentence."""
        characters = self.character[self.character != Regularity.NOT_APPLICABLE]
        if not characters.size:
            return "No orbit is bounded."
        if not self.complete:
            return f"{format_share(code_share(characters, Regularity.NOT_JUDGED))} of the bounded orbits are not judged yet."
        shares = self.chaotic_share, self.share_of(Regularity.NO_SIGN_OF_CHAOS)
        if np.isnan(self.chaotic_share):
            return "All bounded orbits are undecided."
        chaotic, without_sign = (format_share(share, 2) for share in shares)
        undecided_share = code_share(characters, Regularity.UNDECIDED)
        of_which = "judged bounded orbits" if undecided_share else "bounded orbits"
        undecided = f" {format_share(undecided_share, 2)} of the bounded orbits are undecided." if undecided_share else ""
        return f"{chaotic} of the {of_which} are chaotic, {without_sign} show no sign of chaos until t_max.{undecided}"

    def share_of(self, character: Regularity) -> float:
        """Return the share of orbits of a character among the judged bounded orbits; NaN if there are none."""
        return code_share(self.character[np.isin(self.character, JUDGEMENTS)], character)


@shows_progress("regularity")
@checks_types(on_frame=(Callable, type(None)), execution=Execution)
def compute_regularity(
    escape_map: MapLike,
    *,
    on_frame: Callable[[RegularityMap], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> RegularityMap:
    """Judge the bounded orbits of a complete map as regular or chaotic.

    An orbit is regular if the map has evidence of its torus, or if its Birkhoff averages show a torus, over windows that begin
    before t_max/2 or over both halves of the orbit. An orbit is chaotic if its SALI falls to 1e-7 by t_max (Zotos 2014, eq. 9).
    Any other orbit shows no sign of chaos until t_max; Zotos (2014) calls it regular. An orbit that is bounded on the map only
    because of rounding can leave the well in this second integration before its SALI falls. Such an orbit is undecided, as is an
    orbit whose energy is not conserved to 1e-9.

    Parameters
    ----------
    escape_map
        A complete map, or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep.
    on_frame
        Called in this thread with the result so far.
    execution
        How the computation runs. When it is cancelled, orbits not judged yet stay `Regularity.NOT_JUDGED`.

    Raises
    ------
    ValueError
        When the map is not complete, or its potential has gaps in its interior.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_regularity
    >>> escapes = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (20, 20), t_max=2e3))
    >>> round(compute_regularity(escapes).chaotic_share, 2)
    0.23
    """
    escape_map = as_complete_map("escape_map", escape_map)
    escape_map.spec.potential.check_without_gaps("regular and chaotic orbits of a map")
    return analyse_map(escape_map, lambda pixels, _place: _RegularityClassification(pixels), RegularityMap, on_frame, execution)


class _RegularityClassification:
    """Judges the bounded orbits of a map by their deviation vectors and averages, in units of the well."""

    def __init__(self, escape_map: EscapeMap) -> None:
        self._given_spec = escape_map.spec
        self._map = escape_map.in_well_units()
        self._spec = self._map.spec
        codes = np.where(self._map.fate == Fate.BOUNDED, Regularity.NOT_JUDGED, Regularity.NOT_APPLICABLE)
        codes[self._map.evidence == Evidence.QUASI_PERIODIC] = Regularity.REGULAR
        self._codes = PixelCodes(self._map, codes, Regularity.NOT_JUDGED)
        # The pixels still to be judged, (n,), and their orbits, (n, 13), see `attach_deviations`.
        self._pixels = self._codes.pixels
        starts = self._spec.start_states(*self._map.coordinates(self._pixels))
        self._orbits = attach_deviations(starts)
        self._sali, self._energies = np.full((2, codes.size), np.nan)
        self._energies[self._pixels] = self._spec.potential.energy(starts)
        # Time reached by these orbits.
        self._time = 0.0
        # The row of `_curves` for each pixel of the map.
        self._curve_row = self._spec.plane.energy_groups(*self._map.fate.shape)

    def stages(self, execution: Execution, _on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage integrates orbits and judges them by one criterion."""
        # The longest window is not used.
        for time, window in zip(_SALI_TIMES, WINDOWS, strict=False):
            if 2.0 * time > self._spec.t_max:
                break
            yield partial(self._find_chaotic, time, execution)
            yield partial(self._find_tori, window, execution)
        while self._pixels.size and self._time < self._spec.t_max:
            yield partial(self._find_chaotic, min(self._time + _INTERVAL, self._spec.t_max), execution)
        if self._spec.t_max >= MIN_REGULAR_TIME:
            yield partial(self._compare_halves, execution)
        yield self._judge_remaining

    def _find_chaotic(self, time: float, execution: Execution) -> None:
        """Integrate the deviation vectors up to `time`, and judge orbits by their smallest SALI."""
        if not self._pixels.size:
            return
        orbits = propagate_deviations(self._spec.potential, self._orbits, time - self._time, execution=execution)
        is_kept = self._are_inside(orbits[:, :4], execution)
        if execution.is_cancelled:
            return
        is_kept &= is_energy_conserved(self._spec.potential, orbits[:, :4], self._energies[self._pixels])
        # The last column is the smallest SALI so far.
        orbits[~is_kept, -1] = np.nan
        self._orbits, self._time = orbits, time
        self._judge(np.isnan(orbits[:, -1]), Regularity.UNDECIDED)
        self._judge(is_chaotic(self._orbits[:, -1]), Regularity.CHAOTIC)

    def _are_inside(self, states: np.ndarray, execution: Execution) -> np.ndarray:
        """Return whether the states (n, 4) of the remaining orbits are finite and inside all exits, of shape (n,)."""
        batch = OrbitBatch.from_starts(states, self._curve_row[self._pixels])
        batch.mark_outside(self._spec.potential, np.arange(len(states)), self._curves, execution=execution)
        return batch.fate == Fate.NOT_COMPUTED

    @cached_property
    def _curves(self) -> np.ndarray:
        """The exits at the energies of the pixels to judge, see `exit_curves_at`; other rows are not used."""
        curves = np.repeat(closed_exits(self._spec.potential)[None], self._curve_row.max() + 1, axis=0)
        pixels = self._codes.pixels
        rows, first_indices = np.unique(self._curve_row[pixels], return_index=True)
        curves[rows] = exit_curves_at(self._spec.potential, self._energies[pixels[first_indices]])
        return curves

    def _find_tori(self, window: float, execution: Execution) -> None:
        """Judge orbits as regular if their averages agree as on a torus, over windows that begin at the time reached."""
        digits = count_agreeing_digits(self._spec.potential, self._orbits[:, :4], window, execution=execution)
        self._judge(digits >= TORUS_DIGITS, Regularity.REGULAR)

    def _compare_halves(self, execution: Execution) -> None:
        """Judge orbits as regular if their averages agree over both halves of the time from the start to t_max."""
        starts = self._spec.start_states(*self._map.coordinates(self._pixels))
        digits = count_agreeing_digits(self._spec.potential, starts, 0.5 * self._spec.t_max, execution=execution)
        self._judge(digits >= REGULAR_DIGITS, Regularity.REGULAR)

    def _judge_remaining(self) -> None:
        """Judge all remaining orbits as without a sign of chaos."""
        self._judge(np.ones(self._pixels.size, bool), Regularity.NO_SIGN_OF_CHAOS)

    def _judge(self, mask: np.ndarray, character: Regularity) -> None:
        """Assign a code to the orbits selected by a mask (n,), record their SALI, and remove them from the remaining orbits."""
        self._codes.assign(self._pixels[mask], character)
        self._sali[self._pixels[mask]] = self._orbits[mask, -1]
        self._pixels, self._orbits = self._pixels[~mask], self._orbits[~mask]

    def progress(self) -> float:
        """Return the share of the orbits that are judged."""
        return 1.0 - self._pixels.size / max(self._codes.pixels.size, 1)

    def frame(self) -> RegularityMap:
        """Return the result so far."""
        codes, complete = self._codes.snapshot()
        sali = self._codes.mirrored(self._sali.reshape(codes.shape))
        return RegularityMap(self._given_spec, codes, sali, complete=complete)
