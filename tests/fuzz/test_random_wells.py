"""Random open wells of degree 3 to 10 in random units, compared with heyoka.

heyoka integrates in the units in which the well was drawn, the engine in random ones. The Lyapunov orbits are integrated anew:
their paths are the exits, a flood fill on a grid with these exits gives the interior, and an orbit escapes where a finely sampled
path crosses an exit. A fate is robust if a shift of the start by 1e-11 and a coarser tolerance leave channel and crossings as
they are and move the end of the orbit by less than 1e-3.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple, dataclass, field, replace
from functools import cached_property

import numpy as np
import pytest
from scipy import ndimage

from engine import (
    MapSpec,
    Plane,
    Potential,
    Trust,
    classify_orbits,
    compute_map,
    compute_trust,
    find_lyapunov_orbits,
    review_potential,
)
from engine.exits.interior import find_outside_channels
from engine.potentials.well_units import WellUnits
from tests.contracts.test_every_unit import Scaling
from tests.forked import fork_context
from tests.peers.sampled_paths import Exits, Peer

CHUNK = 10
# Times and lengths are in units of the well.
T_MAX, STARTS, SHIFT, APART = 60.0, 20, 1e-11, 1e-3
TOLERANCE, COARSER, ROUNDING = 1e-16, 1e-13, 1e-15
# Largest difference of the escape times of an orbit whose time is steady: it changes by less with the start and the tolerance.
LARGEST_DELAY, STEADY = 1e-4, 1e-6
# Points along a side of the flood fill, and of maps.
GRID, SIDE = 400, 16
# Half the width of the first grid of the flood fill.
SMALLEST = 1e-3
HIGHEST_DEGREE = 10
# Every fifth well is also mapped in both units.
PICTURED = 5
DRAWN = Scaling(1.0, 1.0)
# Refusals of wells that are not open, as no orbit escapes or the escape energy is not defined, and of energies of merged exits.
EXPECTED = ("No saddle leads out", "The well is open without a saddle", "are one exit above V")
# Most other refusals of a chunk.
MOST_REFUSED = 2

chunks = pytest.mark.parametrize(
    "chunk", [pytest.param(k, marks=pytest.mark.exhaustive if k else pytest.mark.slow) for k in range(1000 // CHUNK)]
)


def random_well(seed: int, highest_degree: int = 8) -> Potential:
    """A well with up to ten random terms of degree 3 and higher."""
    random = np.random.default_rng([19, seed])
    degree = int(random.integers(3, highest_degree + 1))
    a, b = random.uniform(0.2, 1.2, 2)
    c = random.uniform(-1.8, 1.8) * np.sqrt(a * b) if random.random() < 0.5 else 0.0
    powers = [(i, n - i) for n in range(3, degree + 1) for i in range(n + 1)]
    chosen = random.choice(len(powers), int(random.integers(1, min(len(powers), 10) + 1)), replace=False)
    terms = {(2, 0): a, (0, 2): b, (1, 1): c} | {powers[k]: 0.5 * random.normal() for k in chosen}
    return Potential(f"random {seed}", tuple((*power, round(value, 4)) for power, value in terms.items() if round(value, 4)))


def random_scaling(seed: int) -> Scaling:
    """Units from the least to the largest that are supported, no powers of 2."""
    length, energy = 10.0 ** np.random.default_rng([20, seed]).uniform(-6.0, 6.0, 2)
    return Scaling(float(length), float(energy))


def flood_fill(potential: Potential, energy: float, exits: Exits) -> tuple[np.ndarray, ...]:
    """x, y (GRID, GRID), whether inside, and whether known: below the energy and three pixels from all exits and walls."""
    corner, inside = np.full(2, SMALLEST * potential.units.length), np.ones((GRID, GRID), bool)
    # Until the grid holds the whole interior, which may be slender.
    while (at_edges := [inside[:, [0, -1]].any(), inside[[0, -1]].any()]) != [False, False]:
        corner *= np.where(at_edges, 1.3, 1.0)
        x, y = np.meshgrid(*(np.linspace(-far, far, GRID) for far in corner))
        barrier = potential.value(x, y) > energy
        for path in exits.paths:
            fine = [np.interp(np.linspace(0, 1, 8 * GRID), np.linspace(0, 1, len(path)), coordinate) for coordinate in path.T]
            columns, rows = (
                ((c / far + 1.0) * 0.5 * (GRID - 1)).round().astype(int) for c, far in zip(fine, corner, strict=True)
            )
            shown = (np.minimum(rows, columns) >= 0) & (np.maximum(rows, columns) < GRID)
            drawn = np.zeros_like(barrier)
            drawn[rows[shown], columns[shown]] = True
            barrier |= ndimage.binary_dilation(drawn, np.ones((3, 3)))
        labels = ndimage.label(~barrier)[0]
        inside = labels == labels[GRID // 2, GRID // 2]
    return x, y, inside, ~ndimage.binary_dilation(barrier, iterations=3)


@dataclass(frozen=True)
class Setting:
    """A well at an energy: for heyoka as it was drawn, for the engine in other units of length and energy."""

    potential: Potential
    energy: float
    scaling: Scaling = DRAWN

    @cached_property
    def scaled(self) -> tuple[Potential, float]:
        """The potential and the energy of the engine."""
        same = self.scaling == DRAWN
        return self.potential if same else self.scaling.potential(self.potential), self.scaling.energy * self.energy

    @cached_property
    def t_max(self) -> float:
        return T_MAX * self.potential.units.time


@dataclass
class Comparison:
    """Exits, regions, robust fates and crossings, and steady escape times that differ, in words, and numbers of orbits."""

    wrong: list[str] = field(default_factory=list)
    robust: int = 0
    undecided: int = 0
    escaped: int = 0


def compare_with_heyoka(potential: Potential, energy: float, seed: int, scaling: Scaling = DRAWN) -> Comparison:
    """The exits, the interior and the outcomes of random orbits of a well at an energy."""
    setting, random, found = Setting(potential, energy, scaling), np.random.default_rng(seed), Comparison()
    peers = Peer(potential, TOLERANCE), Peer(potential, COARSER)
    exits = integrated_exits(setting, peers[0], found)
    compare_orbits(setting, peers, exits, random_starts(setting, exits, random, found), found)
    return found


def integrated_exits(setting: Setting, peer: Peer, found: Comparison) -> Exits:
    """The Lyapunov orbits over half a period, integrated from rest; they must end at rest on the zero-velocity curve."""
    channels, paths = [], []
    potential, units = setting.potential, setting.potential.units
    for orbit in find_lyapunov_orbits(*setting.scaled):
        place = np.array([orbit.x[0], orbit.y[0]]) / setting.scaling.length
        path = peer.path_from_rest(place, 0.5 * orbit.period / setting.scaling.time)
        moved = peer.path_from_rest(place + SHIFT * units.length, 0.5 * orbit.period / setting.scaling.time)[-1] - path[-1]
        # The rounding error of the start grows as a shift of it does.
        rest = 1e-7 * units.momentum + ROUNDING / SHIFT * np.abs(moved[2:]).max()
        error = abs(potential.energy(path[-1]) - setting.energy)
        if np.abs(path[-1, 2:]).max() > rest or error > 1e-9 * units.energy:
            found.wrong.append(f"the Lyapunov orbit across channel {orbit.channel} is not at rest at its other end")
        channels.append(orbit.channel)
        paths.append(path[:, :2])
    return Exits(channels, paths)


def random_starts(setting: Setting, exits: Exits, random: np.random.Generator, found: Comparison) -> np.ndarray:
    """(n, 4) starts in the interior, which must be that of a flood fill."""
    x, y, inside, known = flood_fill(setting.potential, setting.energy, exits)
    sample = random.permutation(np.flatnonzero(known))[:2000]
    x, y, inside = (grid.ravel()[sample] for grid in (x, y, inside))
    regions = find_outside_channels(*setting.scaled, setting.scaling.length * x, setting.scaling.length * y)
    found.wrong += [f"region of ({x[k]}, {y[k]})" for k in np.flatnonzero((regions == 0) != inside)]
    x, y = x[inside][:STARTS], y[inside][:STARTS]
    speed, angle = np.sqrt(2.0 * (setting.energy - setting.potential.value(x, y))), random.uniform(0.0, 2.0 * np.pi, x.size)
    return np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def compare_orbits(setting: Setting, peers: tuple[Peer, Peer], exits: Exits, states: np.ndarray, found: Comparison) -> None:
    """Compare the outcomes of orbits that are robust; the second integrator has the coarser tolerance."""
    units, scaling = setting.potential.units, setting.scaling
    farthest = 3.0 * np.abs(np.concatenate([*exits.paths, setting.potential.saddles])).max()
    ours = classify_orbits(*setting.scaled, scaling.states(states), scaling.time * setting.t_max)
    shift = np.array([SHIFT * units.length, 0.0, 0.0, 0.0])
    for k, state in enumerate(states):
        starts = zip(peers, (state, state + shift), strict=True)
        theirs, other = (peer.end_of(start, exits, setting.t_max, farthest) for peer, start in starts)
        near = float(np.hypot(*(theirs.place - other.place))) < APART * units.length
        robust = near and theirs.outcome == other.outcome
        found.robust += robust
        found.undecided += not robust
        found.escaped += robust and theirs.channel > 0
        outcome = int(ours.fate[k]), int(ours.crossings[k])
        if robust and outcome != theirs.outcome:
            found.wrong.append(f"{outcome} instead of {theirs} from {state.tolist()}")
        elif robust and theirs.channel and abs(theirs.time - other.time) < STEADY * units.time:
            delay = float(ours.escape_time[k]) / scaling.time - theirs.time
            if abs(delay) > LARGEST_DELAY * units.time:
                found.wrong.append(f"escape later by {delay} than {theirs} from {state.tolist()}")


def map_in(scaling: Scaling, potential: Potential, energy: float, plane: Plane) -> MapSpec:
    """A map in other units; on (x, h) of the energies up to this one."""
    t_max = scaling.time * T_MAX * potential.units.time
    energies = (
        (0.9 * scaling.energy * energy, scaling.energy * energy) if plane.energy_axis is not None else scaling.energy * energy
    )
    return MapSpec(scaling.potential(potential), plane, energies, (SIDE, SIDE), t_max=t_max)


def differing_pictures(potential: Potential, energy: float, plane: Plane, scaling: Scaling) -> list[str]:
    """Pixels of a map, which is not doubtful, and its default window, if they are others in other units, in words."""
    usual, scaled = (map_in(units, potential, energy, plane) for units in (DRAWN, scaling))
    window = usual.find_window()
    units = plane.axis_units(WellUnits(scaling.length, scaling.time))
    restored = scaled.find_window().scaled(*(1.0 / unit for unit in units))
    size = max(map(abs, astuple(window)))
    wrong = [] if np.allclose(astuple(restored), astuple(window), rtol=0.0, atol=1e-9 * size) else [f"{restored}, not {window}"]
    first, second = compute_map(usual), compute_map(replace(scaled, window=scaling.window(window, plane)))
    differs = (first.fate != second.fate) | ((first.fate > 0) & (first.crossings != second.crossings))
    doubtful = compute_trust(first).trust == Trust.DOUBTFUL
    return wrong + [f"pixel {place} on {plane.title}" for place in np.argwhere(differs & ~doubtful).tolist()]


def random_energies(potential: Potential, seed: int) -> list[float]:
    """One below the escape energy, one slightly above it, and one up to twice the depth of the well."""
    random = np.random.default_rng([21, seed])
    factors = random.uniform(0.2, 1.0), 1.0 + 10.0 ** random.uniform(-6.0, -1.0), random.uniform(1.02, 2.0)
    return [factor * potential.escape_energy for factor in factors]


def check_well(seed: int) -> tuple[list[Comparison], list[str]]:
    """Comparisons of a well at random energies in random units, and the sentences by which it or its energies are refused."""
    potential, scaling = random_well(seed, HIGHEST_DEGREE), random_scaling(seed)
    usual, review = review_potential(potential), review_potential(scaling.potential(potential))
    assert (review.refusal is None, review.channels) == (usual.refusal is None, usual.channels)
    if review.refusal is not None:
        return [], [review.refusal]
    assert review.escape_energy == pytest.approx(scaling.energy * usual.escape_energy, rel=1e-9)
    comparisons, refusals = [], []
    for energy in random_energies(potential, seed):
        try:
            comparisons.append(compare_with_heyoka(potential, energy, seed, scaling))
        except ValueError as error:
            refusals.append(str(error))
    if seed % PICTURED == 0 and len(comparisons) == 3:
        plane = list(Plane)[seed // PICTURED % len(Plane)]
        comparisons[-1].wrong += differing_pictures(potential, energy, plane, scaling)
    return comparisons, refusals


@chunks
def test_random_wells_in_random_units(chunk: int) -> None:
    seeds = range(CHUNK * chunk, CHUNK * (chunk + 1))
    # In a process of its own, as compiled code stays in memory until the end of its process.
    with ProcessPoolExecutor(1, mp_context=fork_context()) as process:
        found = dict(zip(seeds, process.map(check_well, seeds), strict=True))
    assert not {seed: wrong for seed, (comparisons, _) in found.items() if (wrong := [w for c in comparisons for w in c.wrong])}
    unexpected = {seed: r for seed, (_, refusals) in found.items() for r in refusals if not any(part in r for part in EXPECTED)}
    assert len(unexpected) <= MOST_REFUSED, unexpected


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
    assert not compare_with_heyoka(potential, factor * potential.escape_energy, seed).wrong


@pytest.mark.parametrize("seed", [81, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (154, 454, 896))])
def test_exits_of_several_channels(seed: int) -> None:
    potential = random_well(seed, HIGHEST_DEGREE)
    energy = random_energies(potential, seed)[-1]
    assert potential.well.merged_exits(energy)
    assert not compare_with_heyoka(potential, energy, seed).wrong
