"""The robust pixels of random slices of each kind agree with heyoka.

heyoka starts from states that this module computes from the definitions of the axes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from engine import (
    Coordinate,
    Direction,
    MapSpec,
    ParameterAxis,
    Potential,
    Slice,
    System,
    Trust,
    compute_map,
    compute_trust,
)
from engine.systems.system import TYPED
from tests.peers.exit_lines import exit_lines
from tests.peers.taylor_heyoka import classifier

C = Coordinate
SYSTEMS = (
    System("I"),
    System("II"),
    System("III"),
    System("C5"),
    System(TYPED, "½(x² + y²) − x²y² − a x³", {"a": 0.25}),
    System(TYPED, "½(x² + k1 y²) − b x y²", {"b": 0.9, "k1": 1.2}),
)
# Numbers of kinds of slices, of pixels along a side, of robust pixels compared on each slice, and of their values of a parameter.
KINDS, SIDE, COMPARED, LINES = 11, 24, 10, 3
T_MAX, TOLERANCE = 60.0, 1e-15


def random_slice(random: np.random.Generator, system: System, kind: int) -> Slice:
    """Return a random slice of a kind. Kinds cover any two axes, including oblique axes."""
    held = round(float(random.uniform(-0.15, 0.15)), 3)
    momentum, other = random.permutation([C.PX, C.PY]).tolist()
    angle = random.choice([C.THETA, C.BETA])
    parameter = random.choice([name for name in system.parameter_names if system.value_of(name)])
    value = system.value_of(str(parameter))
    along = ParameterAxis(str(parameter), 0.8 * value, 1.25 * value, system)
    sign = int(random.choice([-1, 1]))
    slices: list[Any] = [
        lambda: Slice(C.X, momentum, other, sign, ((C.Y, held),)),
        lambda: Slice(momentum, C.Y, other, sign, ((C.X, held),)),
        lambda: Slice(C.Y, C.X, momentum, sign, ((other, held),)),
        lambda: Slice(C.Y, C.H, momentum, sign, ((C.X, held),)),
        lambda: Slice(C.X, angle, fixed=((C.Y, held),)),
        lambda: Slice(angle, C.H, fixed=((C.X, held),)),
        lambda: Slice(C.X, C.Y, C.SPEED, fixed=((angle, 10.0 * held),)),
        lambda: Slice(C.X, along, momentum, sign, ((C.Y, held),)),
        lambda: Slice(along, angle, fixed=((C.X, held),)),
        lambda: Slice(Direction("u", x=1.0, y=4.0 * held, **{other.key: 0.5}), C.Y, momentum, sign),
        lambda: Slice(Direction("u", x=1.0, **{other.key: 0.3}), Direction("w", y=0.7, **{other.key: -1.0}), momentum, sign),
    ]
    assert len(slices) == KINDS
    chosen: Slice = slices[kind]()
    return chosen


def state_of(plane: Slice, potential: Potential, energy: float, point: tuple[float, float]) -> np.ndarray:
    """Return x, y, px, py of a point of a slice, from the definition of the axes."""
    start = dict.fromkeys(("x", "y", "px", "py"), 0.0) | {coordinate.key: value for coordinate, value in plane.fixed}
    for axis, along in zip(plane.axes, point, strict=True):
        moved = {name: getattr(axis, name) for name in ("x", "y", "px", "py")} if isinstance(axis, Direction) else {axis.key: 1.0}
        for name, component in moved.items():
            start[name] = start.get(name, 0.0) + component * along
    left = 2.0 * (energy - float(potential.value(start["x"], start["y"])))
    if plane.decided is C.SPEED:
        angle = start["theta"] if "theta" in start else start["beta"] + np.arctan2(start["y"], start["x"])
        start |= {"px": np.sqrt(left) * np.cos(angle), "py": np.sqrt(left) * np.sin(angle)}
    else:
        other = "px" if plane.decided is C.PY else "py"
        start[plane.decided.key] = plane.sign * np.sqrt(left - start[other] ** 2)
    return np.array([start[name] for name in ("x", "y", "px", "py")])


def robust_pixels(plane: Slice, spec: MapSpec, random: np.random.Generator) -> tuple[Any, list[tuple[int, int]]]:
    """Return a map and some of its pixels whose fate does not depend on rounding."""
    found = compute_map(spec)
    trust = compute_trust(found).trust
    robust = np.argwhere(np.isin(trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED)))
    if plane.parameter_axis is not None:
        across = 1 - plane.parameter_axis
        lines = random.choice(np.unique(robust[:, across]), LINES, replace=False)
        robust = robust[np.isin(robust[:, across], lines)]
    return found, [tuple(pixel) for pixel in random.permutation(robust)[:COMPARED].tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("kind", range(KINDS))
def test_fates_of_robust_pixels_agree_with_heyoka(kind: int) -> None:
    random = np.random.default_rng([32, kind])
    system = SYSTEMS[kind % len(SYSTEMS)]
    plane, potential = random_slice(random, system, kind), system.potential
    energy = potential.escape_energy * float(random.uniform(1.15, 1.6))
    energies: Any = energy if plane.energy_axis is None else (1.1 * potential.escape_energy, energy)
    spec = MapSpec(potential, plane, energies, (SIDE, SIDE), t_max=T_MAX, use_evidence=False)
    found, pixels = robust_pixels(plane, spec, random)
    assert len(pixels) == COMPARED
    for row, column in pixels:
        point = float(found.x[column]), float(found.ordinate[row])
        own = plane.potential_at(potential, *point)
        h = float(plane.energies(energy, *point))
        lines = exit_lines(own, h)
        peer = classifier(own, len(lines), TOLERANCE)
        peer.set_exits(lines)
        outcome = peer.classify(state_of(plane, own, h, point)[None], T_MAX)
        assert (found.fate[row, column], found.crossings[row, column]) == (outcome.fate[0], outcome.crossings[0]), (plane, point)
        if outcome.fate[0]:
            assert found.escape_time[row, column] == pytest.approx(outcome.escape_time[0], abs=1e-4)
