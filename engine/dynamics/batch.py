"""Many orbits on their way: their state in arrays, and the carrying on of any of them, tile by tile, on any executor."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, fields, replace
from itertools import islice

import numpy as np

from engine.dynamics.certificates import Certificate
from engine.dynamics.compiled import kernels_of, step_tolerance
from engine.dynamics.fates import Fate
from engine.dynamics.lyapunov_orbits import exit_gates
from engine.execution import count_workers, default_executor, is_cancelled
from engine.potentials.potential import Potential
from engine.taylor.kernels.events import find_outside
from engine.taylor.kernels.propagate import VECTOR, Exits, Orbits
from engine.taylor.source.recurrence import TOLERANCE

LANES = 64
LARGEST_TILE = 2048
# Steps a tile may take before it comes back: about 50 ms, the grain of cancelling and of frames.
BUDGET = 2_000_000


@dataclass
class OrbitBatch:
    """State of n orbits, resumable at any time.

    Attributes
    ----------
    state
        (n, 4) x, y, px, py at time `t`: where the orbit left, or the start of the step that goes on from here.
    t
        (n,) time reached; the escape time of an orbit that has left.
    crossings
        (n,) upward crossings of y = 0 until `t`.
    last_crossings
        (n,) those between `t` and t_max, of a bounded orbit.
    fate
        (n,) int8 codes, see `Fate`.
    curve_row
        (n,) the row of `curves` that holds the exits of this orbit's energy.
    outside
        (n,) int8: the channel beyond whose Lyapunov orbit the start lies, 0 inside.
    certificate
        (n,) int8 codes, see `Certificate`: why an orbit is bounded that has not been followed to t_max; 0 for all others.
    """

    state: np.ndarray
    t: np.ndarray
    crossings: np.ndarray
    last_crossings: np.ndarray
    fate: np.ndarray
    curve_row: np.ndarray
    outside: np.ndarray
    certificate: np.ndarray

    @classmethod
    def from_starts(cls, states: np.ndarray, curve_row: np.ndarray) -> OrbitBatch:
        """Orbits at t = 0; a start whose state is not finite is forbidden. Outside starts are found by `mark_outside`."""
        n = len(states)
        fate = np.where(np.isfinite(states).all(axis=1), Fate.NOT_COMPUTED, Fate.FORBIDDEN).astype(np.int8)
        counts, codes = np.zeros((2, n), np.int64), np.zeros((2, n), np.int8)
        return cls(states.copy(), np.zeros(n), counts[0], counts[1], fate, curve_row.astype(np.int64), codes[0], codes[1])

    def mark_outside(self, which: np.ndarray, curves: np.ndarray) -> None:
        """Find those of the starts `which` that lie beyond an exit curve, and settle their fate."""
        x, y = self.state[which, 0], self.state[which, 1]
        channel = find_outside(x, y, curves, self.curve_row[which])
        channel[self.fate[which] == Fate.FORBIDDEN] = 0
        self.outside[which] = channel
        self.fate[which[channel > 0]] = Fate.OUTSIDE

    def settle(self, which: np.ndarray, certificate: np.ndarray | int) -> None:
        """Call those of the orbits `which` bounded that have a certificate."""
        self.certificate[which] = certificate
        self.fate[which[self.certificate[which] != Certificate.NONE]] = Fate.BOUNDED

    def copy_to_images(self, which: np.ndarray, images: np.ndarray, channels: np.ndarray) -> None:
        """Give the orbits `images` what became of the orbits `which`, of which they are the exact images under x → −x.

        channels: the channel that each one is carried into, see `Potential.mirror_channels`.
        """
        self.state[images] = self.state[which] * [-1.0, 1.0, -1.0, 1.0]
        for name in ("t", "crossings", "last_crossings"):
            getattr(self, name)[images] = getattr(self, name)[which]
        fate = self.fate[which]
        self.fate[images] = np.where(fate > 0, channels[np.maximum(fate, 0)], fate)
        self.outside[images] = channels[self.outside[which]]
        certified = self.certificate[which] != Certificate.NONE
        self.certificate[images] = np.where(certified, Certificate.MIRRORED, Certificate.NONE)

    def reopen_bounded(self) -> None:
        """Make orbits bounded until t_max undecided again, so that they can be carried on; certified ones stay bounded."""
        bounded = (self.fate == Fate.BOUNDED) & (self.certificate == Certificate.NONE)
        self.fate[bounded] = Fate.NOT_COMPUTED
        self.last_crossings[bounded] = 0

    def certificates(self) -> np.ndarray:
        """(n,) int8: the `Certificate` of each orbit, bounded ones followed to t_max included."""
        followed = (self.fate == Fate.BOUNDED) & (self.certificate == Certificate.NONE)
        return np.where(followed, np.int8(Certificate.INTEGRATED), self.certificate)

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return sum(getattr(self, field.name).nbytes for field in fields(self))

    def copy(self) -> OrbitBatch:
        """The same orbits in arrays of their own."""
        return replace(self, **{field.name: getattr(self, field.name).copy() for field in fields(self)})


@dataclass
class _Tile:
    """A part of a batch on its way to a worker and back."""

    orbits: np.ndarray
    batch: OrbitBatch
    waiting: np.ndarray

    @classmethod
    def taken_from(cls, batch: OrbitBatch, orbits: np.ndarray) -> _Tile:
        part = OrbitBatch(**{field.name: getattr(batch, field.name)[orbits] for field in fields(batch)})
        return cls(orbits, part, np.ones(orbits.size, np.uint8))

    def put_back(self, batch: OrbitBatch) -> None:
        for field in fields(batch):
            getattr(batch, field.name)[self.orbits] = getattr(self.batch, field.name)


def _advance_tile(
    potential: Potential,
    curves: np.ndarray,
    gates: np.ndarray,
    tile: _Tile,
    horizon: float,
    final: bool,
    tolerance: float = TOLERANCE,
) -> _Tile:
    """The work of a worker: one budget's worth of steps."""
    kernels = kernels_of(potential)
    todo = np.flatnonzero(tile.waiting)
    b = tile.batch
    kernels.propagate(
        todo, horizon, final, step_tolerance(potential, tolerance), BUDGET, LANES, Exits(gates, curves, b.curve_row),
        Orbits(b.state, b.t, b.crossings, b.last_crossings, b.fate, tile.waiting),
    )  # fmt: skip
    return tile


def _tiles(batch: OrbitBatch, which: np.ndarray, workers: int) -> Iterator[_Tile]:
    share = -(-which.size // (4 * workers))
    size = int(np.clip(-(-share // LANES) * LANES, LANES, LARGEST_TILE))
    for orbits in (which[begin : begin + size] for begin in range(0, which.size, size)):
        yield _Tile.taken_from(batch, orbits)


def _halves(tile: _Tile) -> list[np.ndarray]:
    """What a tile still waits for, in two parts when that is worth a second worker."""
    waiting = tile.orbits[tile.waiting != 0]
    return [part for part in np.array_split(waiting, 2 if waiting.size >= VECTOR else 1) if part.size]


def propagate_batch(
    potential: Potential,
    curves: np.ndarray,
    batch: OrbitBatch,
    which: np.ndarray,
    horizon: float,
    *,
    final: bool,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
    on_progress: Callable[[], None] | None = None,
    tolerance: float = TOLERANCE,
) -> bool:
    """Carry the undecided orbits among `which` on until they leave or reach `horizon`; the batch is changed in place.

    With `final` the horizon is t_max, and orbits still inside are bounded. Returns False when cancelled on the way, which leaves
    the batch in a state to go on from. The outcome of each orbit is the same to the bit whatever the executor and the
    interruptions. `tolerance` is that of the steps; another one than the usual gives a second opinion.
    """
    executor = executor or default_executor()
    workers = count_workers(executor)
    gates = exit_gates(curves)
    todo = which[(batch.fate[which] == Fate.NOT_COMPUTED) & (batch.t[which] < horizon)]
    tiles = _tiles(batch, todo, workers)
    running: set[Future[_Tile]] = set()

    def submit(tile: _Tile) -> None:
        running.add(executor.submit(_advance_tile, potential, curves, gates, tile, horizon, final, tolerance))

    def go_on(tile: _Tile) -> None:
        tile.put_back(batch)
        if is_cancelled(cancel):
            return
        following = [tile] if tile.waiting.any() else list(islice(tiles, 1))
        if len(following) + len(running) < workers:
            following = [_Tile.taken_from(batch, part) for tile in following for part in _halves(tile)]
        for tile in following:
            submit(tile)

    for tile in islice(tiles, 2 * workers):
        submit(tile)
    while running:
        done, running = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            # Of a job that is cancelled, calls that no thread has taken up are cancelled too.
            if not future.cancelled():
                go_on(future.result())
        if on_progress is not None and not is_cancelled(cancel):
            on_progress()
    return not is_cancelled(cancel)
