"""Returns to random sections of each kind agree with the events of heyoka, whose equations are written here."""

from __future__ import annotations

import math
from typing import NamedTuple

import heyoka as hy
import numpy as np
import pytest

from engine import POTENTIALS, Potential, System, classify_orbits, find_returns, sample_starts
from engine.systems.review.potential_review import review_system
from tests.peers.taylor_heyoka import coordinates, equations

NAMES = (
    "I", "II", "III", "C5", "HH", "Barbanis", "One exit", "Copenhagen", "Hill", "Star cluster", "Barred galaxy", "Four hills",
)  # fmt: skip
KINDS, ORBITS = 5, 20
# Followed time in units of the well, tolerance of heyoka, and largest difference of a return in units of the well.
T_MAX, TOLERANCE, LARGEST_DIFFERENCE = 8.0, 1e-17, 1e-10
# One of both integrators may miss a crossing this near to the end of an orbit, in units of the well.
END = 1e-7
DIRECTIONS = {
    "up": hy.event_direction.positive,
    "down": hy.event_direction.negative,
    "both": hy.event_direction.any,
}


class RandomSection(NamedTuple):
    """A section in words, and for heyoka: the form whose zeros count, the direction, and what must be positive there."""

    text: str
    form: hy.expression
    direction: hy.event_direction
    side: hy.expression | None = None


def random_section(random: np.random.Generator, kind: int, length: float) -> RandomSection:
    """Return a section of a kind: a coordinate, a linear form, a ray, an apsis, or an apsis about another centre."""
    x, y, px, py = coordinates()
    name = str(random.choice(list(DIRECTIONS)))
    direction = DIRECTIONS[name]
    value, cx, cy = (round(float(each), 4) for each in random.uniform(-0.2, 0.2, 3) * length)
    if kind == 0:
        axis = str(random.choice(["x", "y"]))
        return RandomSection(f"{axis} = {value} {name}", {"x": x, "y": y}[axis] - value, direction)
    if kind == 1:
        a, b, c = (round(float(each), 3) for each in random.normal(size=3))
        return RandomSection(f"{a} x {b:+} y {c:+} py = {value} {name}", a * x + b * y + c * py - value, direction)
    if kind == 2:
        degrees = round(float(random.uniform(0.0, 360.0)), 2)
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        form, side = cosine * (y - cy) - sine * (x - cx), cosine * (x - cx) + sine * (y - cy)
        return RandomSection(f"angle = {degrees}° about ({cx}, {cy}) {name}", form, direction, side)
    place, cx, cy = (f" about ({cx}, {cy})", cx, cy) if kind == 4 else ("", 0.0, 0.0)
    kind_of_apsis = {"up": "pericentre", "down": "apocentre", "both": "apsis"}[name]
    return RandomSection(kind_of_apsis + place, (x - cx) * px + (y - cy) * py, direction)


def events_of(potential: Potential, section: RandomSection, start: np.ndarray, end: float) -> np.ndarray:
    """Return the crossings of one orbit until a time, (n, 5): x, y, px, py and the time."""
    found: list[np.ndarray] = []

    def note(integrator: hy.taylor_adaptive, time: float, _direction: int) -> None:
        found.append(np.append(integrator.update_d_output(time).copy(), time))

    event = hy.nt_event(section.form, note, direction=section.direction)
    integrator = hy.taylor_adaptive(equations(potential), start.tolist(), tol=TOLERANCE, nt_events=[event], compact_mode=True)
    integrator.propagate_until(end)
    crossings = np.array(found).reshape(-1, 5)
    if section.side is not None and len(crossings):
        side = hy.cfunc([section.side], vars=coordinates())
        crossings = crossings[side(np.ascontiguousarray(crossings[:, :4].T))[0] > 0.0]
    return crossings


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", range(KINDS))
def test_returns_are_the_events_of_another_integrator(name: str, kind: int) -> None:
    random = np.random.default_rng([NAMES.index(name), kind])
    potential, energy = POTENTIALS[name], review_system(System(name)).energies.first
    units = potential.units
    section = random_section(random, kind, units.length)
    states = sample_starts(potential, energy, ORBITS, rng=kind)
    t_max = T_MAX * units.time
    found = find_returns(potential, energy, states, 1000, t_max, section=section.text)
    escape_times = classify_orbits(potential, energy, states, t_max).escape_time
    for k, state in enumerate(states):
        end = t_max if np.isnan(escape_times[k]) else float(escape_times[k])
        expected = events_of(potential, section, state, end)
        count = int(found.count[k])
        ours = np.column_stack([found.states[:count, k], found.time[:count, k]])
        ours, expected = (each[each[:, 4] < end - END * units.time] for each in (ours, expected))
        assert len(ours) == len(expected), (section.text, k)
        difference = np.abs(ours - expected) / np.append(units.state, units.time)
        assert difference.max(initial=0.0) < LARGEST_DIFFERENCE, (section.text, k)
