"""Compare the outcomes of a well at rest with heyoka.

heyoka integrates in the units of the random well, the engine in other units. The Lyapunov orbits are integrated anew, and their
paths are the exits. A flood fill on a grid with these exits gives the interior, and an orbit escapes where its finely sampled
path crosses an exit. A fate is robust if a shift of the start by 1e-11 and a coarser tolerance do not change channel and
crossings, and move the end of the orbit by less than 1e-3.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy import ndimage

from engine import Potential, classify_orbits, find_lyapunov_orbits
from engine.exits.interior import find_outside_channels
from tests.contracts.scaling import Scaling
from tests.peers.sampled_paths import Exits, Peer, parts_of_half

# End time, number of starts, shift of starts, and largest distance of ends of a robust orbit. Units are those of the well.
T_MAX, STARTS, SHIFT, APART = 60.0, 20, 1e-11, 1e-3
TOLERANCE, COARSER, ROUNDING = 1e-16, 1e-13, 1e-15
# Largest difference of a steady escape time from heyoka's, and largest change with start and tolerance of a steady escape time.
LARGEST_DELAY, STEADY = 1e-4, 1e-6
# Points along a side of the flood fill.
GRID = 400
# Half the width of the first grid of the flood fill.
SMALLEST = 1e-3
DRAWN = Scaling(1.0, 1.0)


def flood_fill(potential: Potential, energy: float, exits: Exits) -> tuple[np.ndarray, ...]:
    """Return x, y, whether inside, and whether this is known, each of shape (GRID, GRID).

    Known are points below the energy and three pixels from all exits and walls.
    """
    corner, inside = np.full(2, SMALLEST * potential.units.length), np.ones((GRID, GRID), bool)
    # The grid grows along each axis until it contains the whole interior, which may be slender.
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
    """A well at an energy, in the original units for heyoka, and in other units of length and energy for the engine."""

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
    """Descriptions of exits, regions, robust fates and crossings, and steady escape times that differ, and numbers of orbits."""

    wrong: list[str] = field(default_factory=list)
    robust: int = 0
    undecided: int = 0
    escaped: int = 0


def compare_with_heyoka(potential: Potential, energy: float, seed: int, scaling: Scaling = DRAWN) -> Comparison:
    """Compare the exits, the interior and the outcomes of random orbits of a well at an energy."""
    setting, random, found = Setting(potential, energy, scaling), np.random.default_rng(seed), Comparison()
    peers = Peer(potential, TOLERANCE), Peer(potential, COARSER)
    exits = integrated_exits(setting, peers[0], found)
    compare_orbits(setting, peers, exits, random_starts(setting, exits, random, found), found)
    return found


def integrated_exits(setting: Setting, peer: Peer, found: Comparison) -> Exits:
    """Return the Lyapunov orbits, integrated anew for half a period. They must end at rest on the zero-velocity curve.

    Very unstable orbits are integrated in parts, each of which must end where the next one begins.
    """
    channels, paths = [], []
    potential, units = setting.potential, setting.potential.units
    for orbit in find_lyapunov_orbits(*setting.scaled):
        starts, duration = parts_of_half(orbit)
        starts, duration = starts / setting.scaling.states(np.ones(4)), duration / setting.scaling.time
        parts = [peer.path(start, duration) for start in starts]
        for part, start in zip(parts[:-1], starts[1:], strict=True):
            if not np.abs((part[-1] - start) / units.state).max() < 1e-7:
                found.wrong.append(f"parts of the Lyapunov orbit across channel {orbit.channel} do not meet")
        path = np.concatenate(parts)
        moved = peer.path(starts[-1] + SHIFT * units.length * np.array([1.0, 1.0, 0.0, 0.0]), duration)[-1] - path[-1]
        # The rounding error of the start grows in proportion to a shift of the start.
        rest = 1e-7 * units.momentum + ROUNDING / SHIFT * np.abs(moved[2:]).max()
        error = abs(potential.energy(path[-1]) - setting.energy)
        if np.abs(path[-1, 2:]).max() > rest or error > 1e-9 * units.energy:
            found.wrong.append(f"the Lyapunov orbit across channel {orbit.channel} is not at rest at its other end")
        channels.append(orbit.channel)
        paths.append(path[:, :2])
    return Exits(channels, paths)


def random_starts(setting: Setting, exits: Exits, random: np.random.Generator, found: Comparison) -> np.ndarray:
    """Return starts in the interior, of shape (n, 4). The interior of the engine must be that of a flood fill."""
    x, y, inside, known = flood_fill(setting.potential, setting.energy, exits)
    sample = random.permutation(np.flatnonzero(known))[:2000]
    x, y, inside = (grid.ravel()[sample] for grid in (x, y, inside))
    regions = find_outside_channels(*setting.scaled, setting.scaling.length * x, setting.scaling.length * y)
    found.wrong += [f"region of ({x[k]}, {y[k]})" for k in np.flatnonzero((regions == 0) != inside)]
    x, y = x[inside][:STARTS], y[inside][:STARTS]
    speed, angle = np.sqrt(2.0 * (setting.energy - setting.potential.value(x, y))), random.uniform(0.0, 2.0 * np.pi, x.size)
    return np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def compare_orbits(setting: Setting, peers: tuple[Peer, Peer], exits: Exits, states: np.ndarray, found: Comparison) -> None:
    """Compare the outcomes of robust orbits. The second peer has the coarser tolerance."""
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
