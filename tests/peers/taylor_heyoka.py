"""Find escapes with heyoka, a Taylor integrator with independent recurrences, step control and event detection."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, singledispatch

import heyoka as hy
import numpy as np

from engine import Potential
from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum
from engine.systems.forms.expression_form import ExpressionForm
from engine.systems.forms.polynomial_form import PolynomialForm
from tests.peers.exit_lines import ExitLine

_DEGREE = 12
# Crossings up to this time are the start, which does not count.
START_TIME = 1e-9


@dataclass(frozen=True)
class PeerOutcomes:
    """Channel (0 if bounded), escape time (NaN if bounded) and number of upward crossings of y = 0 of each orbit."""

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray


def coordinates():
    return hy.make_vars("x", "y", "px", "py")


def equations(potential: Potential) -> list:
    x, y, px, py = coordinates()
    fx, fy = (_in_heyoka(potential.form.force(axis)) for axis in (0, 1))
    if potential.rotation:
        fx, fy = fx + 2.0 * potential.rotation * py, fy - 2.0 * potential.rotation * px
    return [(x, px), (y, py), (px, fx), (py, fy)]


@singledispatch
def _in_heyoka(form):
    raise TypeError(form)


@_in_heyoka.register
def _(form: PolynomialForm):
    x, y, *_ = coordinates()
    # Products instead of powers, because the series of y**3 divides by y.
    terms = (math.prod([x] * i + [y] * j, start=hy.expression(c)) for i, j, c in form.terms)
    return sum(terms, start=hy.expression(0.0))


@_in_heyoka.register
def _(form: ExpressionForm):
    return _node(form.expression)


def _node(expression: Expression):
    match expression:
        case Coordinate(axis):
            return coordinates()[axis]
        case Sum(constant, terms):
            return sum((c * _node(part) for part, c in terms), start=hy.expression(constant))
        case Product(factors):
            return math.prod((_power(_node(base), n) for base, n in factors), start=hy.expression(1.0))
        case Function(name, argument):
            return getattr(hy, name)(_node(argument))
    raise TypeError(expression)


def _power(base, exponent: float):
    if exponent > 0.0 and exponent == int(exponent):
        return math.prod([base] * int(exponent), start=hy.expression(1.0))
    return base**exponent


def taylor_coefficients(potential: Potential, state: np.ndarray) -> np.ndarray:
    """Return the coefficients of x and y about a state, of shape (2, order + 1)."""
    integrator = hy.taylor_adaptive(equations(potential), state.tolist(), tol=1e-18)
    integrator.step(write_tc=True)
    return integrator.tc[:2].copy()


class Classifier:
    """Classifies orbits of one potential. The exits are parameters of the compiled integrator, so it is compiled only once."""

    def __init__(self, potential: Potential, channels: int, tolerance: float) -> None:
        x, y, *_ = coordinates()
        exits = [
            hy.t_event(self._beyond(k, x, y), callback=self._left(k), direction=hy.event_direction.positive)
            for k in range(channels)
        ]
        upward = hy.nt_event(y, self._upward, direction=hy.event_direction.positive)
        self.crossings, self.channel = 0, 0
        self.lines: list[ExitLine] = []
        self.integrator = hy.taylor_adaptive(
            equations(potential),
            [0.0] * 4,
            tol=tolerance,
            t_events=exits,
            nt_events=[upward],
            pars=[0.0] * (channels * 18),
        )

    @staticmethod
    def _beyond(k: int, x, y):
        mx, my, ox, oy, half_width, *coefficients = (hy.par[18 * k + n] for n in range(18))
        u, s = ox * (x - mx) + oy * (y - my), (ox * (y - my) - oy * (x - mx)) / half_width
        graph = coefficients[_DEGREE]
        for c in coefficients[_DEGREE - 1 :: -1]:
            graph = graph * s + c
        return u - graph

    def _left(self, k: int):
        def callback(integrator, _sign: int) -> bool:
            line = self.lines[k]
            # The polynomial is not valid beside the chord.
            if abs(line.in_chord_axes(*integrator.state[:2])[1]) > 1.001 * line.q[-1]:
                return True
            self.channel = line.channel
            return False

        return callback

    def _upward(self, _integrator, time: float, _sign: int) -> None:
        self.crossings += time > START_TIME

    def set_exits(self, lines: list[ExitLine]) -> None:
        """Set the exits for an energy."""
        self.lines = lines
        for k, line in enumerate(lines):
            s = line.q / line.q[-1]
            fit = np.polynomial.Chebyshev.fit(s, line.u, _DEGREE, domain=[-1, 1])
            assert np.abs(fit(s) - line.u).max() < 1e-8
            numbers = [*line.middle, *line.outward, line.q[-1], *fit.convert(kind=np.polynomial.Polynomial).coef]
            self.integrator.pars[18 * k : 18 * k + len(numbers)] = numbers

    def __deepcopy__(self, _memo: object) -> Classifier:
        # heyoka copies its callbacks, and all copies must update the counters of this object.
        return self

    def classify(self, states: np.ndarray, t_max: float) -> PeerOutcomes:
        outcomes = PeerOutcomes(np.zeros(len(states), int), np.full(len(states), np.nan), np.zeros(len(states), int))
        for n, state in enumerate(states):
            self.crossings, self.channel = 0, 0
            self.integrator.reset_cooldowns()
            self.integrator.time = 0.0
            self.integrator.state[:] = state
            self.integrator.propagate_until(t_max)
            assert np.isfinite(self.integrator.state).all()
            outcomes.fate[n], outcomes.crossings[n] = self.channel, self.crossings
            if self.channel:
                outcomes.escape_time[n] = self.integrator.time
        return outcomes


@cache
def classifier(potential: Potential, channels: int, tolerance: float) -> Classifier:
    return Classifier(potential, channels, tolerance)


def classify(
    potential: Potential, lines: list[ExitLine], states: np.ndarray, t_max: float, tolerance: float = 1e-18
) -> PeerOutcomes:
    cached = classifier(potential, len(lines), tolerance)
    cached.set_exits(lines)
    return cached.classify(states, t_max)


@cache
def _plain(potential: Potential):
    return hy.taylor_adaptive(equations(potential), [0.0] * 4, tol=1e-18)


def propagated(potential: Potential, states: np.ndarray, duration: float) -> np.ndarray:
    """Return states after a duration, which may be negative, of shape (n, 4)."""
    integrator = _plain(potential)
    out = np.empty_like(states)
    for n, state in enumerate(states):
        integrator.time = 0.0
        integrator.state[:] = state
        integrator.propagate_until(duration)
        out[n] = integrator.state
    return out
