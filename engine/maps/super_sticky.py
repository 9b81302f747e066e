"""Super-sticky orbits: chaotic, bounded until t_max, and gone long after it (Zotos 2014, section 4.3).

They keep to the outermost invariant tori, in and out of chains of islands and through cantori, and find an exit late or not at
all within any time that can be waited for.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass

import numpy as np

from engine.arrays import read_only
from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.classification import read_outcomes
from engine.dynamics.fates import Fate, Regularity
from engine.dynamics.lyapunov_orbits import exit_curves
from engine.dynamics.planes import Plane, find_mirror_images
from engine.maps.regularity import RegularityMap
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.validation import read_t_max


@dataclass(frozen=True, eq=False)
class SuperStickySearch:
    """The chaotic bounded starts of a map, followed on; arrays are read-only and share one length n.

    Every such start of the map is there, row by row. Where the map is its own mirror image, both images count, and only one of
    each two was followed: the other leaves at the same time through the channel opposite.

    Attributes
    ----------
    spec
        The map's request.
    bounded
        How many starts of the map are bounded until its t_max, regular ones included.
    x, ordinate
        (n,) places of the starts on the plane.
    states
        (n, 4) x, y, px, py of the starts.
    fate, escape_time, crossings
        (n,) as in `engine.Outcomes`, all counted from the start; `Fate.BOUNDED` for those that have not left by `t_max`.
    images
        How many starts stand for one orbit that was followed: 2 where mirror images count, else 1.
    t_max
        How long they were followed.
    """

    spec: MapSpec
    bounded: int
    x: np.ndarray
    ordinate: np.ndarray
    states: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    images: int
    t_max: float

    @property
    def chaotic_share(self) -> float:
        """Share of the starts here among the bounded ones of the map; NaN when there are none."""
        return self.fate.size / self.bounded if self.bounded else float("nan")

    @property
    def leavers(self) -> np.ndarray:
        """(m,) places in the arrays of those that left, in order of escape time."""
        left = np.flatnonzero(self.fate >= 1)
        places: np.ndarray = left[np.argsort(self.escape_time[left], kind="stable")]
        return places

    def describe(self) -> str:
        """What came of it, in two sentences."""
        if not self.fate.size:
            return f"None of the {self.bounded} bounded starts is chaotic."
        counted = ", both mirror images counted" if self.images > 1 else ""
        found = f"{self.fate.size} of the {self.bounded} bounded starts are chaotic ({100 * self.chaotic_share:.1f} %{counted})."
        return f"{found} {self._describe_leavers()}"

    def _describe_leavers(self) -> str:
        leavers = self.leavers
        if not leavers.size:
            return f"None of them leaves by t = {self.t_max:.4g}."
        channels, counts = np.unique(self.fate[leavers], return_counts=True)
        by_channel = ", ".join(f"{count} through channel {channel}" for channel, count in zip(channels, counts, strict=True))
        times = self.escape_time[leavers]
        return (
            f"{leavers.size} of them leave by t = {self.t_max:.4g} ({by_channel}): the first at t = {times[0]:.6g}, "
            f"half of these by {np.median(times):.6g}, the last at {times[-1]:.6g}."
        )


def find_super_sticky_orbits(
    whole: EscapeMap,
    regularity: RegularityMap,
    t_max: float,
    *,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
    on_progress: Callable[[float], None] | None = None,
) -> SuperStickySearch:
    """Follow the chaotic bounded orbits of a map until they leave, or much longer than the map did.

    Parameters
    ----------
    whole
        A complete map on (x, y) or (x, px).
    regularity
        What `compute_regularity` says of it, complete.
    t_max
        How long to follow them from their start, at least as long as the map did, at most 1e8. The paper's last one leaves at
        3.5e6.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, the work stops within about 0.1 s.
    on_progress
        Called in this thread with the share of the work that is certainly done, 0 to 1.

    Returns
    -------
    `SuperStickySearch`, equal to the bit whatever the executor. At such times an orbit has forgotten its start to the last digit:
    which orbit leaves when is an accident of rounding, how many leave is not.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When the map or the judgement is not complete, they do not belong together, the map is on (x, h), or `t_max` is out of
        its range.
    """
    _check(whole, regularity, t_max)
    pixels = np.flatnonzero(regularity.character.ravel() == Regularity.CHAOTIC)
    rows, columns = np.divmod(pixels, whole.x.size)
    x, ordinate = whole.x[columns], whole.ordinate[rows]
    images = find_mirror_images(whole.spec.potential, whole.spec.plane, whole.x, whole.ordinate)
    states = whole.spec.start_states(x, ordinate)
    first = pixels <= images[pixels] if images is not None else np.ones(pixels.size, bool)
    batch = OrbitBatch.from_starts(states, np.zeros(pixels.size, np.int64))
    _follow(whole.spec, batch, np.flatnonzero(first), float(t_max), executor, cancel, on_progress)
    if images is not None:
        paired = np.flatnonzero(pixels < images[pixels])
        batch.copy_to_images(paired, np.searchsorted(pixels, images[pixels[paired]]), whole.spec.potential.mirror_channels)
    outcomes = read_outcomes(whole.spec.potential, np.full(pixels.size, whole.spec.energy), batch)
    arrays = (x, ordinate, states, outcomes.fate, outcomes.escape_time, outcomes.crossings)
    x, ordinate, states, fate, escape_time, crossings = map(read_only, arrays)
    bounded = int(np.count_nonzero(whole.fate == Fate.BOUNDED))
    counted = 1 if images is None else 2
    return SuperStickySearch(
        whole.spec, bounded, x, ordinate, states, fate, escape_time, crossings, images=counted, t_max=float(t_max)
    )  # fmt: skip


def _follow(
    spec: MapSpec,
    batch: OrbitBatch,
    which: np.ndarray,
    t_max: float,
    executor: Executor | None,
    cancel: threading.Event | None,
    on_progress: Callable[[float], None] | None,
) -> None:
    """Carry orbits of a batch on to t_max."""
    assert not isinstance(spec.energy, tuple)

    def report() -> None:
        if on_progress is not None:
            covered = np.where(batch.fate[which] == Fate.NOT_COMPUTED, np.minimum(batch.t[which] / t_max, 1.0), 1.0)
            on_progress(float(covered.mean()))

    curves = exit_curves(spec.potential, spec.energy)[None]
    if not propagate_batch(
        spec.potential, curves, batch, which, t_max, final=True, executor=executor, cancel=cancel, on_progress=report
    ):  # fmt: skip
        raise CancelledError


def _check(whole: EscapeMap, regularity: RegularityMap, t_max: float) -> None:
    if not whole.complete:
        raise ValueError("whole: is not complete; bounded orbits are known only then")
    if whole.spec.plane is Plane.X_H:
        raise ValueError(f"whole: is on {Plane.X_H.value}; must have one energy")
    if regularity.spec != whole.spec or not regularity.complete:
        raise ValueError("regularity: must be the complete judgement of the same map")
    if read_t_max(t_max) < whole.spec.t_max:
        raise ValueError(f"t_max={t_max}: must be at least that of the map, {whole.spec.t_max:g}")
