"""Follow orbits with heyoka: to the first exit that their sampled path crosses, to infinity, or with a deviation vector."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import heyoka as hy
import numpy as np

from tests.peers.sampled_paths import Exits
from tests.referee.own_system import OwnSystem

TOLERANCE = 1e-16
# Points of a path in a step, and number of times that the interval of a crossing is sampled anew.
_SAMPLES, _ZOOMS = 16, 6
# Points of an exit.
_EXIT_POINTS = 2001
# Largest number of steps of an orbit, and largest change of its energy in units of kinetic and potential energy. heyoka chooses
# steps from its series, which does not show a narrow feature of V ahead.
_MOST_STEPS, _LARGEST_CHANGE = 200_000, 1e-8
# Number of steps after which the distance is compared with the farthest.
_STEPS_AT_ONCE = 20
# Factors of the distance up to which an orbit is followed, and smallest ratio of its mean speeds if it leaves for ever.
_FARTHER, _MUCH_FARTHER, _STEADY_SPEED = 10.0, 100.0, 0.97
# Factors of the distance at which V is compared with the energy on the way to infinity.
_FAR = np.geomspace(1.0, 1e8, 200)


class UndecidedError(Exception):
    """An orbit cannot be followed: its steps become too many, its state is not finite, or its energy changes."""


class EnergyError(UndecidedError):
    """The energy of an own orbit changes."""


@dataclass(frozen=True)
class Step:
    """A step of an orbit: its times, and its Taylor coefficients of shape (4, order + 1)."""

    begin: float
    end: float
    coefficients: np.ndarray

    def states(self, times: np.ndarray) -> np.ndarray:
        """Return the states at times, of shape (n, 4)."""
        powers = np.vander(times - self.begin, self.coefficients.shape[1], increasing=True)
        return powers @ self.coefficients.T


@dataclass(frozen=True)
class End:
    """The end of an orbit: the exit crossed (0 without one), the time, and the state there."""

    channel: int
    time: float
    state: np.ndarray


class OwnOrbits:
    """Integrates orbits of a system. `farthest` is the distance from the origin at which an orbit is not followed further."""

    def __init__(self, system: OwnSystem, farthest: float) -> None:
        self.system, self.farthest = system, farthest

    @cached_property
    def _plain(self) -> hy.taylor_adaptive:
        return hy.taylor_adaptive(self.system.equations(), [0.0] * 4, tol=TOLERANCE, compact_mode=True)

    @cached_property
    def _varied(self) -> hy.taylor_adaptive:
        return hy.taylor_adaptive(self.system.variational_equations(), [0.0] * 8, tol=TOLERANCE, compact_mode=True)

    def steps(self, start: np.ndarray, t_max: float, *, farther: float = 1.0) -> Iterator[Step]:
        """Yield the steps of an orbit until t_max or `farthest` times a factor."""
        integrator = self._plain
        integrator.time = 0.0
        integrator.state[:] = start
        for _ in range(_MOST_STEPS):
            begin = float(integrator.time)
            integrator.step(max_delta_t=t_max - begin, write_tc=True)
            self._check(start, integrator.state)
            yield Step(begin, float(integrator.time), integrator.tc.copy())
            if integrator.time >= t_max or np.hypot(*integrator.state[:2]) > farther * self.farthest:
                return
        raise UndecidedError("too many steps")

    def state_at(
        self, start: np.ndarray, duration: float, *, varied: bool = False, farthest: float | None = None
    ) -> tuple[float, np.ndarray]:
        """Return time and state at the end of a duration, or where the orbit is beyond `farthest`."""
        farthest = self.farthest if farthest is None else farthest
        integrator = self._varied if varied else self._plain
        integrator.time = 0.0
        integrator.state[:] = start
        for _ in range(_MOST_STEPS // _STEPS_AT_ONCE):
            integrator.propagate_until(duration, max_steps=_STEPS_AT_ONCE)
            self._check(start, integrator.state)
            if integrator.time >= duration or np.hypot(*integrator.state[:2]) > farthest:
                return float(integrator.time), integrator.state.copy()
        raise UndecidedError("too many steps")

    def _check(self, start: np.ndarray, state: np.ndarray) -> None:
        """Raise UndecidedError unless a state is finite and has the energy of the start."""
        if not np.isfinite(state).all():
            raise UndecidedError("a state is not finite")
        places, momenta = np.array([start[:2], state[:2]]), np.array([start[2:4], state[2:4]])
        potential, kinetic = self.system.value(*places.T), 0.5 * np.sum(momenta**2, axis=1)
        if not abs(np.diff(potential + kinetic)[0]) <= _LARGEST_CHANGE * np.sum(np.abs(potential) + kinetic):
            raise EnergyError("the energy of an own orbit changes")

    def path(self, start: np.ndarray, duration: float) -> np.ndarray:
        """Return the states of an orbit, evenly spaced in time, of shape (n, 4)."""
        times = np.linspace(0.0, duration, _EXIT_POINTS)
        path = np.full((times.size, 4), np.nan)
        for step in self.steps(start, duration):
            within = (times >= step.begin) & (times <= step.end)
            path[within] = step.states(times[within])
        return path

    def end_of(self, start: np.ndarray, exits: Exits, t_max: float, *, farther: float = 1.0) -> End:
        """Return the end of an orbit at the first exit that it crosses, at t_max, or at `farthest` times a factor."""
        if not exits.channels:
            return End(0, *self.state_at(start, t_max))
        for step in self.steps(start, t_max, farther=farther):
            end, channel = _first_crossing(exits, step)
            if channel:
                return End(channel, end, step.states(np.array([end]))[0])
            last = step
        return End(0, last.end, self._plain.state.copy())

    def leaves(self, state: np.ndarray) -> bool:
        """Whether an orbit at a state moves away for ever.

        Either V stays below its energy along its direction, far out, or the orbit does not slow down up to 100 times the
        distance, as in a channel, where it oscillates across its direction.
        """
        place, momentum = state[:2], state[2:4]
        if not place @ momentum > 0.0:
            return False
        energy = 0.5 * momentum @ momentum + self.system.value(*place)
        direction = momentum / np.hypot(*momentum)
        distance = np.hypot(*place)
        value = self.system.value(*(place[:, None] + direction[:, None] * distance * (_FAR - 1.0)))
        if np.isfinite(value[0]) and not np.any(value > energy):
            return True
        longest = _MUCH_FARTHER * distance / (place @ momentum / distance)
        times = []
        for factor in (_FARTHER, _MUCH_FARTHER):
            time, end = self.state_at(state, longest, farthest=factor * distance)
            times.append(time / (np.hypot(*end[:2]) - distance))
            if np.hypot(*end[:2]) < factor * distance:
                return False
        return bool(times[1] < times[0] / _STEADY_SPEED)

    def time_of_leaving(self, start: np.ndarray, duration: float) -> float:
        """Return when an orbit is found beyond `farthest` within a duration, from where it leaves for ever; infinite if not."""
        time, state = self.state_at(start, duration)
        return time if np.hypot(*state[:2]) > self.farthest and self.leaves(state) else np.inf

    def growth(self, start: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Return ln(|w(t)|/|w(0)|) of a deviation vector at times (n,); UndecidedError if the orbit leaves."""
        state, logarithms, begin, total = np.array([*start, 0.5, 0.5, 0.5, 0.5]), [], 0.0, 0.0
        for time in times:
            for piece in np.diff(np.linspace(begin, time, max(2, int(np.ceil((time - begin) / self._renormalized))))):
                time_reached, state = self.state_at(state, piece, varied=True)
                if time_reached < piece or np.hypot(*state[:2]) > self.farthest:
                    raise UndecidedError("the orbit leaves")
                length = np.hypot(np.hypot(*state[4:6]), np.hypot(*state[6:8]))
                state[4:] /= length
                total += float(np.log(length))
            logarithms.append(total)
            begin = time
        return np.array(logarithms)

    @property
    def _renormalized(self) -> float:
        """Interval between renormalizations, a few periods of the fastest oscillation at the origin."""
        fastest = float(np.sqrt(np.abs(np.linalg.eigvalsh(self.system.curvature(0.0, 0.0))).max()))
        return 10.0 / (fastest or 1.0)


def _first_crossing(exits: Exits, step: Step) -> tuple[float, int]:
    """Return when an orbit first crosses an exit in a step, and the channel; 0 without crossing."""
    begin, end, crossed = step.begin, step.end, 0
    for _ in range(_ZOOMS):
        times = np.linspace(begin, end, _SAMPLES)
        segment, channel = exits.first_crossed(step.states(times)[:, :2])
        if not channel:
            break
        (begin, end), crossed = times[segment : segment + 2], channel
    return 0.5 * (begin + end), crossed
