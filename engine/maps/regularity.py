"""The bounded orbits of a map: which are regular, which chaotic."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from engine.dynamics.certificates import Certificate
from engine.dynamics.compiled import fixed_step_size, kernels_of
from engine.dynamics.deviation_vectors import DEVIATION_VECTORS
from engine.dynamics.fates import CHAOS_THRESHOLD, Fate, Regularity
from engine.dynamics.fixed_step_batches import glide
from engine.dynamics.planes import find_mirror_images
from engine.execution import is_cancelled
from engine.invariant_sets.birkhoff_averages import CERTIFIED_DIGITS, WINDOWS, count_agreeing_digits
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.potentials.potential import Potential

# SALI up to these times, with the search for tori between: what is strongly chaotic falls early, most of what is regular shows
# itself as a torus, and the few that are neither are followed to t_max.
_SALI_TIMES = (1000.0, 5000.0, 20000.0)
# A piece of the way, after which orbits already judged are left behind.
_PIECE = 5000.0


@dataclass(frozen=True, eq=False)
class RegularityMap:
    """Which bounded orbits of a map are regular and which chaotic, finished or on the way.

    Attributes
    ----------
    spec
        The map's request.
    character
        (rows, columns) int8 `Regularity` codes.
    complete
        Whether every bounded pixel is judged.
    """

    spec: MapSpec
    character: np.ndarray
    complete: bool

    @property
    def nbytes(self) -> int:
        """Bytes held by the array."""
        return self.character.nbytes

    @property
    def chaotic_share(self) -> float:
        """Share of chaotic orbits among the bounded ones judged; NaN when there are none."""
        judged = np.isin(self.character, (Regularity.REGULAR, Regularity.CHAOTIC))
        return float(np.mean(self.character[judged] == Regularity.CHAOTIC)) if judged.any() else float("nan")


def compute_regularity(
    escape_map: EscapeMap,
    on_frame: Callable[[RegularityMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
) -> RegularityMap:
    """Tell regular from chaotic among the bounded orbits of a finished map.

    An orbit certified as quasi-periodic is regular. Another is chaotic when its SALI falls to 1e-7 by t_max (eq. 9 of Zotos
    2014), regular when its averages turn out to be those of a torus, or when t_max comes first. One that runs off, which no
    orbit bounded to the bit does, depends on rounding: it is chaotic.

    Parameters
    ----------
    escape_map
        A complete map.
    on_frame
        Called in this thread with what is known so far.
    cancel
        When set, orbits not judged stay `Regularity.NOT_JUDGED`.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.

    Raises
    ------
    ValueError
        When the map is not complete.
    """
    if not escape_map.complete:
        raise ValueError("escape_map: is not complete; bounded orbits are known only then")
    run = _Judgement(escape_map, cancel, executor)
    for round_of_work in run.rounds():
        if run.cancelled():
            break
        round_of_work()
        if on_frame is not None:
            on_frame(run.result())
    return run.result()


class _Judgement:
    """The orbits not judged yet: their states, deviations and the time these have reached."""

    def __init__(self, escape_map: EscapeMap, cancel: threading.Event | None, executor: Executor | None) -> None:
        spec = self.spec = escape_map.spec
        self.potential = spec.potential
        self.pool: dict[str, Any] = {"cancel": cancel, "executor": executor}
        self.character = np.zeros(escape_map.fate.shape, np.int8)
        bounded = escape_map.fate == Fate.BOUNDED
        self.character[bounded] = Regularity.NOT_JUDGED
        self.character[escape_map.certificate == Certificate.QUASI_PERIODIC] = Regularity.REGULAR
        self.images = find_mirror_images(self.potential, spec.plane, escape_map.x, escape_map.ordinate)
        self.pixels = np.flatnonzero(self.character == Regularity.NOT_JUDGED)
        if self.images is not None:
            self.pixels = self.pixels[self.pixels <= self.images[self.pixels]]
        x, ordinate = (grid.ravel()[self.pixels] for grid in np.meshgrid(escape_map.x, escape_map.ordinate))
        states = spec.start_states(x, ordinate)
        # Rows: x, y, px, py of the orbit and of two deviations, and the smallest SALI so far.
        vectors = np.broadcast_to(DEVIATION_VECTORS.ravel(), (self.pixels.size, 8))
        self.orbits = np.column_stack([states, vectors, np.full(self.pixels.size, np.inf)])
        self.time = 0.0

    def rounds(self) -> Iterator[Callable[[], None]]:
        """The work in pieces, shortest first."""
        for until, window in zip(_SALI_TIMES, WINDOWS, strict=False):
            if 2.0 * until > self.spec.t_max:
                break
            yield partial(self.follow, until)
            yield partial(self.seek_tori, window)
        while self.pixels.size and self.time < self.spec.t_max:
            yield partial(self.follow, min(self.time + _PIECE, self.spec.t_max))
        yield partial(self.judge_all, Regularity.REGULAR)

    def follow(self, until: float) -> None:
        """Carry deviations on, and judge those orbits chaotic whose SALI has fallen."""
        if not self.pixels.size:
            return
        steps = max(1, round((until - self.time) / fixed_step_size(self.potential)))
        carried = glide(_carry, self.potential, self.orbits, steps, shape=self.orbits.shape[1:], **self.pool)
        if self.cancelled():
            return
        self.orbits, self.time = carried, until
        self.judge(~(carried[:, -1] > CHAOS_THRESHOLD), Regularity.CHAOTIC)

    def seek_tori(self, window: float) -> None:
        """Judge those regular that run on a torus."""
        digits = count_agreeing_digits(self.potential, self.orbits[:, :4], window, **self.pool)
        self.judge(digits >= CERTIFIED_DIGITS, Regularity.REGULAR)

    def judge_all(self, character: Regularity) -> None:
        """Settle what is left."""
        self.judge(np.ones(self.pixels.size, bool), character)

    def cancelled(self) -> bool:
        """Whether nobody waits any more."""
        cancel = self.pool["cancel"]
        return is_cancelled(cancel)

    def judge(self, which: np.ndarray, character: Regularity) -> None:
        """Settle some of the orbits and leave them behind."""
        self.character.ravel()[self.pixels[which]] = character
        self.pixels, self.orbits = self.pixels[~which], self.orbits[~which]

    def result(self) -> RegularityMap:
        """As far as it is known."""
        character = self.character.copy()
        if self.images is not None:
            later = np.flatnonzero(self.images < np.arange(self.images.size))
            character.ravel()[later] = character.ravel()[self.images[later]]
        character.flags.writeable = False
        return RegularityMap(self.spec, character, not np.any(character == Regularity.NOT_JUDGED))


def _carry(potential: Potential, tile: np.ndarray, steps: int) -> np.ndarray:
    """Orbits with two deviations and their smallest SALI, some steps on."""
    kernels = kernels_of(potential)
    with np.errstate(invalid="ignore"):
        kernels.fixed_step_sali(fixed_step_size(potential), steps, tile[:4], tile[4:8], tile[8:12], tile[12])
    return tile.T
