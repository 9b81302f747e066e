"""Find escapes with heyoka in any potential: an orbit leaves where its finely sampled path crosses that of a Lyapunov orbit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import heyoka as hy
import numpy as np

from engine import LyapunovOrbit, Potential
from tests.peers import taylor_heyoka

# Number of points of a path in each step, number of times that the interval of a crossing is sampled anew, number of points of an
# exit.
_SAMPLES, _ZOOMS, _EXIT_POINTS = 16, 5, 2001


@dataclass(frozen=True)
class Exits:
    """The exits of one energy: their channels, and their paths of shape (n, 2)."""

    channels: list[int]
    paths: list[np.ndarray]

    def first_crossed(self, path: np.ndarray) -> tuple[int, int]:
        """Return the index of the first segment of a path that crosses an exit, and the channel of the exit; 0 without one.

        The path has the shape (m, 2).
        """
        crossings = [(int(np.argmax(hits)), channel) for channel, hits in self._hits(path) if hits.any()]
        return min(crossings, default=(0, 0))

    @cached_property
    def _boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """The lower and the upper corners (exits, 2) of boxes around the paths."""
        return np.array([line.min(axis=0) for line in self.paths]), np.array([line.max(axis=0) for line in self.paths])

    def _hits(self, path: np.ndarray):
        if not self.paths:
            return
        low, high = path.min(axis=0), path.max(axis=0)
        for k in np.flatnonzero(((self._boxes[0] <= high) & (self._boxes[1] >= low)).all(axis=1)):
            line = self.paths[k]
            near = ((np.minimum(line[:-1], line[1:]) <= high) & (np.maximum(line[:-1], line[1:]) >= low)).all(axis=1)
            starts, ends = line[:-1][near], line[1:][near]
            passes_line = np.diff(_are_left(path[None], starts[:, None], ends[:, None]), axis=1)
            first, last = path[:-1], path[1:]
            passes_path = _are_left(starts[:, None], first, last) != _are_left(ends[:, None], first, last)
            yield self.channels[k], (passes_line & passes_path).any(axis=0)


def _are_left(points: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return whether points lie on the left of segments; the last axis has the coordinates."""
    along, apart = ends - starts, points - starts
    return along[..., 0] * apart[..., 1] > along[..., 1] * apart[..., 0]


def parts_of_half(orbit: LyapunovOrbit) -> tuple[np.ndarray, float]:
    """Return the states (n, 4) from which the parts of the first half of an orbit begin, and the duration of a part.

    A very unstable orbit has ten parts, other orbits one.
    """
    starts = np.vstack([orbit.start, orbit.inner_states])
    starts = starts[: max(len(starts) // 2, 1)]
    return starts, 0.5 * orbit.period / len(starts)


@dataclass(frozen=True)
class End:
    """The end of an orbit: channel (0 for none), time, place of shape (2,), and number of upward crossings of y = 0 before."""

    channel: int
    time: float
    crossings: int
    place: np.ndarray

    @property
    def outcome(self) -> tuple[int, int]:
        """The channel and the number of crossings."""
        return self.channel, self.crossings


class Peer:
    """Integrates orbits of a potential with heyoka, with one tolerance."""

    def __init__(self, potential: Potential, tolerance: float) -> None:
        self.upward: list[float] = []
        # The lambda has no reference to this object, because heyoka would keep it for ever.
        passed = self.upward.append
        y, upward = taylor_heyoka.coordinates()[1], hy.event_direction.positive
        # heyoka does not copy a lambda.
        rising = hy.nt_event(y, lambda _integrator, time, _sign: passed(time), direction=upward)
        equations = taylor_heyoka.equations(potential)
        self.integrator = hy.taylor_adaptive(equations, [0.0] * 4, tol=tolerance, nt_events=[rising], compact_mode=True)

    def start(self, state: np.ndarray) -> None:
        self.integrator.time = 0.0
        self.integrator.state[:] = state
        self.upward.clear()

    def path(self, start: np.ndarray, duration: float) -> np.ndarray:
        """Return the states of an orbit, evenly spaced in time, of shape (n, 4)."""
        self.start(start)
        path: np.ndarray = self.integrator.propagate_grid(np.linspace(0.0, duration, _EXIT_POINTS))[-1]
        return path

    def end_of(self, state: np.ndarray, exits: Exits, t_max: float, farthest: float) -> End:
        """Return the end of an orbit at the first exit that it crosses, at t_max, or at the distance `farthest`."""
        self.start(state)
        while self.integrator.time < t_max and np.hypot(*self.integrator.state[:2]) < farthest:
            begin = self.integrator.time
            self.integrator.step(max_delta_t=t_max - begin, write_tc=True)
            end, channel = self._first_crossing(exits, begin, self.integrator.time)
            if channel:
                return End(channel, end, sum(time <= end for time in self.upward), self._path(np.array([end]))[0])
        return End(0, self.integrator.time, len(self.upward), self.integrator.state[:2].copy())

    def _first_crossing(self, exits: Exits, begin: float, end: float) -> tuple[float, int]:
        """Return when an orbit first crosses an exit between two times of the last step, and the channel; 0 without crossing."""
        crossed = 0
        for _ in range(_ZOOMS):
            times = np.linspace(begin, end, _SAMPLES)
            segment, channel = exits.first_crossed(self._path(times))
            if not channel:
                break
            (begin, end), crossed = times[segment : segment + 2], channel
        return float(end), crossed

    def _path(self, times: np.ndarray) -> np.ndarray:
        return np.array([self.integrator.update_d_output(time)[:2].copy() for time in times])
