"""Random open wells of degree 3 to 8, compared with heyoka.

heyoka integrates the Lyapunov orbits anew. Their paths are the exits, a flood fill on a grid with these exits gives the interior,
and an orbit escapes where a finely sampled path crosses an exit. A fate is robust if a shift of the start by 1e-9 leaves it as it
is and moves the end of the orbit by less than 1e-3.
"""

from __future__ import annotations

from dataclasses import dataclass

import heyoka as hy
import numpy as np
import pytest
from scipy import ndimage

from engine import LyapunovOrbit, Potential, classify_orbits, find_lyapunov_orbits, review_potential
from engine.exits.interior import find_outside_channels
from tests.peers import taylor_heyoka

CHUNK = 20
T_MAX, STARTS, SHIFT, APART = 30.0, 10, 1e-9, 1e-3
GRID, SAMPLES = 400, 16
# Refusals of wells that are not open: no orbit escapes, or the escape energy is not defined.
NOT_OPEN = ("No saddle leads out", "The well is open without a saddle")
# Most wells of a chunk whose energy, below all maxima between their exits, is refused.
MOST_REFUSED = 2

chunks = pytest.mark.parametrize(
    "chunk", [pytest.param(k, marks=pytest.mark.exhaustive if k else pytest.mark.slow) for k in range(1000 // CHUNK)]
)


def random_well(seed: int) -> Potential:
    """A well with up to ten random terms of degree 3 to 8."""
    random = np.random.default_rng([19, seed])
    degree = int(random.integers(3, 9))
    a, b = random.uniform(0.2, 1.2, 2)
    c = random.uniform(-1.8, 1.8) * np.sqrt(a * b) if random.random() < 0.5 else 0.0
    powers = [(i, n - i) for n in range(3, degree + 1) for i in range(n + 1)]
    chosen = random.choice(len(powers), int(random.integers(1, min(len(powers), 10) + 1)), replace=False)
    terms = {(2, 0): a, (0, 2): b, (1, 1): c} | {powers[k]: 0.5 * random.normal() for k in chosen}
    return Potential(f"random {seed}", tuple((*power, round(value, 4)) for power, value in terms.items() if round(value, 4)))


@dataclass(frozen=True)
class Exits:
    """The exits of one energy: (n, 2) paths and their channels."""

    channels: list[int]
    paths: list[np.ndarray]

    def first_crossed(self, path: np.ndarray) -> int:
        """The channel of the exit that a path (m, 2) crosses first, 0 if none."""
        crossings = [(int(np.argmax(hits)), channel) for channel, hits in self._hits(path) if hits.any()]
        return min(crossings)[1] if crossings else 0

    def _hits(self, path: np.ndarray):
        for channel, line in zip(self.channels, self.paths, strict=True):
            along, apart = np.diff(line, axis=0)[:, None], path - line[:-1, None]
            left = along[..., 0] * apart[..., 1] > along[..., 1] * apart[..., 0]
            along, apart = np.diff(path, axis=0)[:, None], line - path[:-1, None]
            below = along[..., 0] * apart[..., 1] > along[..., 1] * apart[..., 0]
            yield channel, ((left[:, 1:] != left[:, :-1]) & (below[:, 1:] != below[:, :-1]).T).any(axis=0)


def integrated_exit(potential: Potential, integrator: hy.taylor_adaptive, orbit: LyapunovOrbit) -> np.ndarray:
    """The path of a Lyapunov orbit over half a period, integrated from rest; it must end at rest on the zero-velocity curve."""
    integrator.time = 0.0
    integrator.state[:] = [orbit.x[0], orbit.y[0], 0.0, 0.0]
    _, path = integrator.propagate_grid(np.linspace(0.0, 0.5 * orbit.period, 401))[-2:]
    units = potential.units
    assert np.abs(path[-1, 2:]).max() < 1e-7 * units.momentum
    assert abs(potential.value(*path[-1, :2]) - orbit.energy) < 1e-9 * units.energy
    return path[:, :2]


def fate_of(
    integrator: hy.taylor_adaptive, exits: Exits, state: np.ndarray, t_max: float, farthest: float
) -> tuple[int, np.ndarray]:
    """The channel of the first exit that an orbit crosses, 0 for none until t_max, and where the orbit ends."""
    integrator.time = 0.0
    integrator.state[:] = state
    last = state[:2].copy()
    while integrator.time < t_max and np.hypot(*last) < farthest:
        begin = integrator.time
        integrator.step(max_delta_t=t_max - begin, write_tc=True)
        times = np.linspace(begin, integrator.time, SAMPLES)[1:]
        path = np.array([last, *(integrator.update_d_output(time)[:2].copy() for time in times)])
        channel = exits.first_crossed(path)
        if channel:
            return channel, path[-1]
        last = path[-1]
    return 0, last


def flood_fill(potential: Potential, energy: float, exits: Exits) -> tuple[np.ndarray, ...]:
    """x, y (GRID, GRID), whether inside, and whether known: below the energy and three pixels from all exits and walls."""
    corner = 1.3 * max(np.abs(np.concatenate(exits.paths)).max(), potential.units.length)
    axis = np.linspace(-corner, corner, GRID)
    x, y = np.meshgrid(axis, axis)
    barrier = potential.value(x, y) > energy
    for path in exits.paths:
        fine = [np.interp(np.linspace(0, 1, 8 * GRID), np.linspace(0, 1, len(path)), coordinate) for coordinate in path.T]
        columns, rows = (np.clip(((c + corner) / (axis[1] - axis[0])).round().astype(int), 0, GRID - 1) for c in fine)
        drawn = np.zeros_like(barrier)
        drawn[rows, columns] = True
        barrier |= ndimage.binary_dilation(drawn, np.ones((3, 3)))
    labels = ndimage.label(~barrier)[0]
    inside = labels == labels[GRID // 2, GRID // 2]
    return x, y, inside, ~ndimage.binary_dilation(barrier, iterations=3)


def wrong_outcomes(potential: Potential, energy: float, seed: int) -> int:
    """Number of starts whose region or whose robust fate differs."""
    random = np.random.default_rng(seed)
    orbits = find_lyapunov_orbits(potential, energy)
    integrator = hy.taylor_adaptive(taylor_heyoka.equations(potential), [0.0] * 4, tol=1e-16)
    exits = Exits([o.channel for o in orbits], [integrated_exit(potential, integrator, o) for o in orbits])
    x, y, inside, known = flood_fill(potential, energy, exits)
    sample = random.permutation(np.flatnonzero(known))[:2000]
    x, y, inside = (grid.ravel()[sample] for grid in (x, y, inside))
    wrong = np.count_nonzero((find_outside_channels(potential, energy, x, y) == 0) != inside)
    x, y = x[inside][:STARTS], y[inside][:STARTS]
    speed, angle = np.sqrt(2.0 * (energy - potential.value(x, y))), random.uniform(0.0, 2.0 * np.pi, x.size)
    states = np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])
    t_max = T_MAX * potential.units.time
    farthest = 3.0 * np.abs(np.concatenate(exits.paths)).max()
    ours = classify_orbits(potential, energy, states, t_max).fate
    for state, fate in zip(states, ours, strict=True):
        shift = np.array([SHIFT * potential.units.length, 0.0, 0.0, 0.0])
        (theirs, end), (shifted, other) = (fate_of(integrator, exits, start, t_max, farthest) for start in (state, state + shift))
        robust = theirs == shifted and np.hypot(*(end - other)) < APART * potential.units.length
        wrong += robust and theirs != fate
    return wrong


@chunks
def test_random_wells(chunk: int) -> None:
    wrong, refused = [], []
    for seed in range(CHUNK * chunk, CHUNK * (chunk + 1)):
        potential = random_well(seed)
        review = review_potential(potential)
        if review.refusal is not None and review.refusal.startswith(NOT_OPEN):
            continue
        factor = np.random.default_rng(seed).uniform(1.02, 2.0)
        energy = factor * potential.escape_energy
        if energy > review.highest_energy:
            with pytest.raises(ValueError, match="are one above the maximum between them"):
                find_lyapunov_orbits(potential, energy)
            continue
        try:
            count = wrong_outcomes(potential, energy, seed)
        except ValueError as error:
            refused.append((seed, factor, str(error)))
            continue
        if count:
            wrong.append((seed, factor, count))
    assert not wrong
    assert len(refused) <= MOST_REFUSED, refused


@pytest.mark.parametrize(
    ("seed", "factor"),
    [
        (97, 2.0),
        (299, 1.25),
        *(pytest.param(*well, marks=pytest.mark.slow) for well in ((131, 1.25), (155, 2.0), (275, 1.1))),
    ],
)
def test_exits_found_by_continuation_or_from_both_ends(seed: int, factor: float) -> None:
    potential = random_well(seed)
    assert wrong_outcomes(potential, factor * potential.escape_energy, seed) == 0
