"""Comparison of the browser's pixels with the server's: random views of systems of the catalogue, down to 1e-6 of the plane.

Needs Node.js. Run: uv run python -m benchmarks.agreement
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from engine import MapSpec, System, Trust, compute_map, compute_trust
from engine.slices.default_window import default_window
from engine.slices.portable_system import make_portable_system
from engine.systems.review.potential_review import review_system
from tests.app.browser.test_agreement import HORIZON, SIDE, SLICES, as_view, expected_fate, zoom_on_boundary
from tests.node import run_node

SYSTEMS = ("I", "III", "C5", "HH", "Barred galaxy", "Copenhagen", "Two Yukawa centres")
ZOOMS = (0, 2, 6)


def random_views(system: System, chance: np.random.Generator) -> Iterator[MapSpec]:
    """Views of a system on random slices at random energies, one for each zoom."""
    potential = system.potential
    energies = review_system(system).energies
    low, high = max(potential.escape_energy, energies.low), energies.high
    for zooms in ZOOMS:
        plane = SLICES[chance.integers(len(SLICES))]
        ends = low + 0.05 * (high - low), low + 0.9 * (high - low)
        energy = ends if plane.energy_axis is not None else chance.uniform(*ends)
        window = default_window(potential, plane, energy)
        spec = MapSpec(potential, plane, energy, (SIDE, SIDE), window, HORIZON * potential.units.time, use_evidence=False)
        for _ in range(zooms):
            spec = zoom_on_boundary(spec, chance)
        yield spec


def main() -> None:
    print("| system | slice | side of the window | pixels with the same fate | robust pixels | largest difference of times |")
    print("|---|---|---|---|---|---|")
    chance = np.random.default_rng(1)
    for name in SYSTEMS:
        system = System(name)
        specs = list(random_views(system, chance))
        portable = make_portable_system(system.potential, review_system(system).energies.high)
        data = {"system": portable.to_dict(), "module": portable.module, "views": [as_view(spec) for spec in specs]}
        with tempfile.TemporaryDirectory() as folder:
            pictures = run_node("run_view.js", data, Path(folder))
        for spec, found in zip(specs, pictures, strict=True):
            report(name, spec, np.array(found["fate"]), np.array(found["time"], float))


def report(name: str, spec: MapSpec, fate: np.ndarray, time: np.ndarray) -> None:
    """Return one line: all pixels, the robust ones, and the times of those that escape in both."""
    escape_map, window = compute_map(spec), spec.find_window()
    expected = expected_fate(escape_map).ravel()
    same = fate == expected
    robust = np.isin(compute_trust(escape_map).trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED)).ravel()
    escaped = robust & same & (fate > 0)
    difference = np.abs(time / escape_map.escape_time.ravel() - 1.0)[escaped].max(initial=0.0)
    print(
        f"| {name} | {spec.plane.title} | {window.x_high - window.x_low:.1e} | {same.sum()} of {same.size} |"
        f" {(same & robust).sum()} of {robust.sum()} | {difference:.1e} |",
        flush=True,
    )


if __name__ == "__main__":
    main()
