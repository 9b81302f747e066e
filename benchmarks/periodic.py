"""Measure the processor time of each step with periodic orbits: search, nearest orbit, family, branches, symmetric families.

Kernels are compiled before. The search and the symmetric families use all cores, whose times are added.

Run: uv run python -m benchmarks.periodic
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

from engine import (
    CASES,
    POTENTIALS,
    MapSpec,
    Plane,
    Potential,
    SpecialKind,
    continue_family,
    find_periodic_orbit,
    find_periodic_orbits,
    find_symmetric_families,
)
from engine.slices.axes import Coordinate
from engine.slices.slice import Slice

STARTS, RETURNS = (60, 60), 2
# Points at which branches are sought. Near resonances m : n with a large n, several distances are tried.
_MEETING = SpecialKind.BRANCHING, SpecialKind.DOUBLING, SpecialKind.TOUCHING


class Subject(NamedTuple):
    """What is measured.

    Attributes
    ----------
    potential
        The potential.
    state
        A start near a periodic orbit.
    until
        The energies between which its family is followed.
    along_energy
        A slice of starts along the energy, and its section.
    """

    potential: Potential
    state: tuple[float, float, float, float]
    until: tuple[float, float]
    along_energy: tuple[Slice, str] = (Plane.X_H, "y = 0")


SUBJECTS = (
    Subject(CASES["III"], (0.0, 0.0, 0.0, 0.63), (0.1, 0.7)),
    Subject(POTENTIALS["HH"], (0.0, 0.0, 0.0, 0.45), (0.08, 0.1664), (Slice(Coordinate.Y, Coordinate.H, Coordinate.PX), "x = 0")),
    Subject(POTENTIALS["Hill"], (0.28, 0.0, 0.0, 1.5), (-2.6, -2.1)),
    Subject(POTENTIALS["Copenhagen"], (-0.25, 0.0, 0.0, 1.18), (-2.2, -1.9)),
)


def timed[T](function: Callable[[], T]) -> tuple[T, float]:
    """Return the result of a function, and the processor time in ms."""
    begin = time.process_time()
    return function(), 1e3 * (time.process_time() - begin)


def measure(subject: Subject) -> list[str]:
    """Return the cells of a row of the table."""
    potential = subject.potential
    orbit = find_periodic_orbit(potential, subject.state, 1)
    spec = MapSpec(potential, Plane.X_PX, orbit.energy, STARTS, t_max=100.0)
    plane, section = subject.along_energy
    along_energy = MapSpec(potential, plane, subject.until, STARTS, t_max=100.0, section=section)
    found, search = timed(lambda: find_periodic_orbits(spec, returns=RETURNS))
    _, nearest = timed(lambda: find_periodic_orbit(potential, subject.state, 1))
    family, following = timed(lambda: continue_family(orbit, subject.until))
    middles = 0.5 * (family.energy[1:] + family.energy[:-1])
    _, between = timed(lambda: [family.at(float(h)) for h in middles])
    numbers = [k for k, point in enumerate(family.special) if point.kind in _MEETING]
    branches, switching = timed(lambda: [family.switch(k) for k in numbers])
    families, symmetric = timed(lambda: find_symmetric_families(along_energy, returns=RETURNS))
    searches = (search, len(found)), (symmetric, len(families.x))
    steps = (following, len(family)), (between, len(middles)), (switching, sum(map(len, branches)))
    return [
        potential.name,
        *(f"{whole:.0f} ({number})" for whole, number in searches),
        f"{nearest:.1f}",
        *(f"{whole / number:.1f} ({number})" if number else "–" for whole, number in steps),
    ]


def main() -> None:
    columns = (
        "search (orbits)", "symmetric families (points)", "nearest orbit",
        "a member (members)", "an orbit between members (orbits)", "a branch (branches)",
    )  # fmt: skip
    print(f"| potential | {' | '.join(columns)} |\n|{'---|' * (len(columns) + 1)}")
    for subject in SUBJECTS:
        # The first run compiles.
        measure(subject)
        print(f"| {' | '.join(measure(subject))} |", flush=True)


if __name__ == "__main__":
    main()
