"""Compare fates where a formula has bodies, an escape circle, arcs, a mass or a rotating frame with SciPy's DOP853."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from engine import Potential, System, classify_orbits
from tests.referee.formulas import Formula
from tests.referee.own_system import OwnSystem
from tests.referee.report import REFUSED, UNDECIDED, Report

CHECK = "ends"
DURATION = 30.0
# Shift of a start, and largest change of the time of an end and largest difference of two times.
_SHIFT, _STEADY, _SAME_TIME = 1e-8 * np.array([1.0, -0.7, 0.3, 0.5]), 1e-4, 1e-5
# Largest kinetic energy of a start, and size of the steps between which events are looked for.
_MOST_KINETIC, _LONGEST_STEP = 2000.0, 0.05


@dataclass(frozen=True)
class Ends:
    """The ends of orbits of a formula: bodies (name, x, y, radius), and a circle of `arcs` exits, 0 for an undivided circle."""

    bodies: tuple[tuple[str, float, float, float], ...]
    radius: float
    arcs: int
    first_angle: float | None
    mass: float
    rotation: float

    @property
    def clauses(self) -> str:
        text = "".join(f"; centre {name} ({x}, {y}) {radius}" for name, x, y, radius in self.bodies)
        begin = "" if self.first_angle is None else f" from {self.first_angle}"
        arcs = f" exits {self.arcs}{begin}" if self.arcs else ""
        masses = "" if self.mass == 1.0 else f"; masses ({self.mass}, {self.mass})"
        return f"{text}; escape {self.radius}{arcs}{masses}"

    def exit_at(self, x: float, y: float) -> int:
        """Return the number of the exit at a place of the circle."""
        if not self.arcs:
            return 1
        begin = -180.0 / self.arcs if self.first_angle is None else self.first_angle
        return int(((math.degrees(math.atan2(y, x)) - begin) % 360.0) / (360.0 / self.arcs)) + 1

    def events(self) -> list[Callable[[float, np.ndarray], float]]:
        """Return the events that end an orbit, those of the bodies first."""
        circles = [(x, y, radius, -1.0) for _, x, y, radius in self.bodies] + [(0.0, 0.0, self.radius, 1.0)]
        return [_event(*circle) for circle in circles]


def _event(x: float, y: float, radius: float, direction: float) -> Callable[[float, np.ndarray], float]:
    def event(_time: float, state: np.ndarray) -> float:
        return float((state[0] - x) ** 2 + (state[1] - y) ** 2 - radius**2)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


def random_case(seed: int) -> tuple[Formula, Ends]:
    """Return the formula of a seed, without clauses, and its ends."""
    choice = random.Random(f"ends {seed}")
    kind = choice.choice([_well, _hills, _bodies])
    text, bodies = kind(choice)
    arcs = choice.choice([0, 2, 3, 5])
    first_angle = choice.choice([None, 30.0, 90.0]) if arcs else None
    mass = choice.choice([1.0, round(choice.uniform(0.3, 8.0), 3)])
    rotation = choice.choice([0.0, round(choice.uniform(-0.6, 0.6), 3)])
    return Formula(text), Ends(bodies, round(choice.uniform(3.5, 9.0), 3), arcs, first_angle, mass, rotation)


def _number(choice: random.Random, low: float, high: float) -> str:
    return f"{choice.uniform(low, high):.4f}"


def _well(choice: random.Random) -> tuple[str, tuple[()]]:
    powers = choice.sample([(3, 0), (2, 1), (1, 2), (0, 3), (2, 2), (4, 0)], 2)
    terms = "".join(f"{choice.choice('+-')}{_number(choice, 0.05, 0.6)}*x^{i}*y^{j}" for i, j in powers)
    return f"0.5*({_number(choice, 0.3, 1.5)}*x^2+{_number(choice, 0.3, 1.5)}*y^2){terms}", ()


def _hills(choice: random.Random) -> tuple[str, tuple[()]]:
    places = [(_number(choice, -2.0, 2.0), _number(choice, -2.0, 2.0)) for _ in range(3)]
    return "+".join(f"{_number(choice, 0.5, 2.0)}*exp(-(x-({x}))^2-(y-({y}))^2)" for x, y in places), ()


def _bodies(choice: random.Random) -> tuple[str, tuple[tuple[str, float, float, float], ...]]:
    places = [(0.0, 0.0), (round(choice.uniform(0.5, 1.5), 3), round(choice.uniform(-1.5, 1.5), 3))]
    bodies = tuple((name, x, y, round(10.0 ** choice.uniform(-3.0, -0.7), 5)) for name, (x, y) in zip("AB", places, strict=True))
    text = "".join(f"-{_number(choice, 0.3, 1.5)}/sqrt((x-({x}))^2+(y-({y}))^2)" for _, x, y, _ in bodies)
    return f"{text}+{_number(choice, 0.05, 0.5)}*x^2*exp(-{_number(choice, 0.2, 1.0)}*y^2)", bodies


def check_ends(seed: int, starts: int, report: Report) -> None:
    """Compare the fates of random starts at three energies."""
    formula, ends = random_case(seed)
    system, text = OwnSystem(formula.expression), formula.text + ends.clauses
    potential = System.from_formula(text, **({"rotation": ends.rotation} if ends.rotation else {})).potential
    random_numbers = np.random.default_rng(seed)
    radius, angle = 0.95 * ends.radius * np.sqrt(random_numbers.random(400)), random_numbers.uniform(0.0, 2.0 * np.pi, 400)
    places = radius * np.array([np.cos(angle), np.sin(angle)])
    value = system.value(*places) - 0.5 * ends.mass * ends.rotation**2 * radius**2
    for energy in (*np.quantile(value, (0.3, 0.7)), value.max() + random_numbers.uniform(0.1, 3.0)):
        states = _states(ends, places, float(energy) - value, random_numbers)[:starts]
        _check_states(potential, system, ends, float(energy), states, {"seed": seed, "formula": text}, report)


def _states(ends: Ends, places: np.ndarray, kinetic: np.ndarray, random_numbers: np.random.Generator) -> np.ndarray:
    """Return the starts of an energy outside the bodies, of shape (n, 4), with random directions."""
    is_legal = (kinetic > 0.0) & (kinetic < _MOST_KINETIC)
    for _, x, y, radius in ends.bodies:
        is_legal &= np.hypot(places[0] - x, places[1] - y) > 1.01 * radius
    momentum = np.sqrt(2.0 * ends.mass * np.maximum(kinetic, 0.0))
    angle = random_numbers.uniform(0.0, 2.0 * np.pi, kinetic.shape)
    return np.stack([*places, momentum * np.cos(angle), momentum * np.sin(angle)], axis=-1)[is_legal]


def _check_states(
    potential: Potential,
    system: OwnSystem,
    ends: Ends,
    energy: float,
    states: np.ndarray,
    known: dict[str, object],
    report: Report,
) -> None:
    try:
        found = classify_orbits(potential, energy, states, t_max=DURATION)
    except ValueError as error:
        report.add(CHECK, REFUSED, str(error), len(states))
        return
    labels = [outcome.label for outcome in potential.outcomes]
    bodies = [next(k for k, label in enumerate(labels, 1) if label.endswith(f"with {name}")) for name, *_ in ends.bodies]
    exits = [k for k in range(1, len(labels) + 1) if k not in bodies]
    for k, state in enumerate(states):
        (fate, time), (other_fate, other_time) = (
            _follow(system, ends, start, bodies, exits) for start in (state, state + _SHIFT)
        )
        if fate != other_fate or abs(time - other_time) > _STEADY:
            report.add(CHECK, UNDECIDED, "the end changes with a shift of the start")
            continue
        agrees = found.fate[k] == fate and (fate == 0 or abs(found.escape_time[k] - time) < _SAME_TIME)
        answers = {"own": (fate, time), "engine": (int(found.fate[k]), float(found.escape_time[k]))}
        report.judge(CHECK, "the end of an orbit differs", bool(agrees), **known, energy=energy, state=state.tolist(), **answers)


def _follow(system: OwnSystem, ends: Ends, state: np.ndarray, bodies: list[int], exits: list[int]) -> tuple[int, float]:
    """Return the fate of an orbit, 0 for a bounded one, and the time of its end."""
    mass, rotation = ends.mass, ends.rotation

    def derivatives(_time: float, state: np.ndarray) -> list[float]:
        x, y, px, py = state
        slope_x, slope_y = system.gradient(x, y) - mass * rotation**2 * np.array([x, y])
        return [px / mass, py / mass, 2.0 * rotation * py - slope_x, -2.0 * rotation * px - slope_y]

    result = solve_ivp(
        derivatives, (0.0, DURATION), state, "DOP853", rtol=1e-12, atol=1e-13, events=ends.events(), max_step=_LONGEST_STEP
    )
    for k, (times, places) in enumerate(zip(result.t_events, result.y_events, strict=True)):
        if times.size:
            fate = bodies[k] if k < len(bodies) else exits[ends.exit_at(*places[0][:2]) - 1]
            return fate, float(times[0])
    return 0, DURATION
