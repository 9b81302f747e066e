"""All robust pixels of the browser, and nearly all others, agree with the server's map up to the same time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import (
    Coordinate,
    Direction,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Slice,
    System,
    Trust,
    Window,
    compute_map,
    compute_trust,
)
from engine.slices.default_window import default_window
from engine.slices.portable_system import make_portable_system
from engine.systems.review.potential_review import review_system
from engine.systems.system import TYPED
from tests.node import needs_node, run_node

SYSTEMS = (
    System("I"),
    System("III"),
    System(TYPED, "½(x² + y²) − x²y² − x³/4"),
    System(TYPED, "½r² − a x²y exp(−y²)", {"a": 2.0}),
)
SLICES = (
    *Plane,
    Slice(Coordinate.H, Coordinate.X),
    Slice(Coordinate.PX, Coordinate.Y, fixed=((Coordinate.X, 0.05),)),
    Slice(Coordinate.X, Coordinate.THETA, fixed=((Coordinate.Y, 0.05),)),
    Slice(Coordinate.BETA, Coordinate.H, fixed=((Coordinate.X, 0.1),)),
    Slice(Direction("u", x=1.0, y=0.5), Coordinate.PX),
    Slice(Direction("u", y=1.0, py=-0.5), Direction("w", x=0.5, py=1.0)),
)
# Numbers of zooms by a factor of ten.
ZOOMS = (0, 0, 2, 2, 5, 9)
SIDE, COARSE, HORIZON = 30, 10, 30.0
# Smallest share of equal pixels, including sensitive pixels.
LEAST_SHARE = 0.995


def random_specs(system: System, chance: np.random.Generator, all_zooms: Sequence[int]) -> Iterator[MapSpec]:
    """Yield a view of a system for each number of zooms. Plane and energy are random, and zooms lead to basin boundaries."""
    potential, energies = system.potential, review_system(system).energies
    low, high = max(potential.escape_energy, energies.low), energies.high
    ends = low + 0.05 * (high - low), low + 0.9 * (high - low)
    for zooms in all_zooms:
        plane = SLICES[chance.integers(len(SLICES))]
        energy = ends if plane.energy_axis is not None else chance.uniform(*ends)
        window = default_window(potential, plane, energy)
        spec = MapSpec(potential, plane, energy, (SIDE, SIDE), window, HORIZON * potential.units.time, use_evidence=False)
        for _ in range(zooms):
            spec = zoom_on_boundary(spec, chance)
        yield spec


def zoom_on_boundary(spec: MapSpec, chance: np.random.Generator) -> MapSpec:
    """Return a view ten times smaller, around a random pixel whose neighbour has another exit, or else around the middle."""
    coarse = compute_map(replace(spec, resolution=(COARSE, COARSE)))
    left, right = coarse.fate[:, :-1], coarse.fate[:, 1:]
    places = np.argwhere((left != right) & (left >= 1) & (right >= 1))
    row, column = chance.choice(places) if places.size else (COARSE // 2, COARSE // 2)
    x, ordinate, window = coarse.x[column], coarse.ordinate[row], spec.find_window()
    half = 0.05 * (window.x_high - window.x_low), 0.05 * (window.ordinate_high - window.ordinate_low)
    return replace(spec, window=Window(x - half[0], x + half[0], ordinate - half[1], ordinate + half[1]))


def as_view(spec: MapSpec) -> dict[str, Any]:
    window = dict(zip(("xLow", "xHigh", "ordinateLow", "ordinateHigh"), vars(spec.find_window()).values(), strict=True))
    shape = {"columns": SIDE, "rows": SIDE, "horizon": HORIZON}
    return {"slice": spec.plane.to_dict(spec.potential.units), "energy": spec.common_energy or 0.0, "window": window, **shape}


def run_views(system: System, specs: Sequence[MapSpec], folder: Path) -> Any:
    """Return what the browser's engine finds in views of a system."""
    portable = make_portable_system(system.potential, review_system(system).energies.high)
    views = [as_view(spec) for spec in specs]
    return run_node("run_view.js", {"system": portable.to_dict(), "module": portable.module, "views": views}, folder)


def expected_fate(escape_map: EscapeMap) -> np.ndarray:
    """Return the fates of a map, undecided for orbits that are inside at the horizon."""
    return np.where(escape_map.fate == Fate.BOUNDED, Fate.NOT_COMPUTED, escape_map.fate)


@needs_node
@pytest.mark.parametrize("number", range(len(SYSTEMS)), ids=[system.title for system in SYSTEMS])
def test_pixels_are_those_of_the_map(number: int, tmp_path: Path) -> None:
    specs = list(random_specs(SYSTEMS[number], np.random.default_rng(number), ZOOMS))
    same = []
    for spec, found in zip(specs, run_views(SYSTEMS[number], specs, tmp_path), strict=True):
        escape_map = compute_map(spec)
        expected, fate = expected_fate(escape_map).ravel(), np.array(found["fate"])
        robust = np.isin(compute_trust(escape_map).trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED)).ravel()
        np.testing.assert_array_equal(fate[robust], expected[robust], err_msg=str(spec))
        escaped = robust & (expected > 0)
        np.testing.assert_array_equal(np.array(found["crossings"])[escaped], escape_map.crossings.ravel()[escaped])
        times = np.array(found["time"], float)[escaped]
        np.testing.assert_allclose(times, escape_map.escape_time.ravel()[escaped], rtol=0.01)
        same.append(fate == expected)
    assert float(np.mean(same)) >= LEAST_SHARE
