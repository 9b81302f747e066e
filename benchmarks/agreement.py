"""Compare the browser's pixels with the server's, in random views of systems of the catalogue, down to 1e-6 of the plane.

Needs Node.js. Run: uv run python -m benchmarks.agreement
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from engine import MapSpec, System, Trust, compute_map, compute_trust
from tests.plots.browser.test_agreement import expected_fate, random_specs, run_views

SYSTEMS = ("I", "III", "C5", "HH", "Barred galaxy", "Copenhagen", "Two Yukawa centres")
# Numbers of zooms from the whole plane to each view.
ZOOMS = (0, 2, 6)


def main() -> None:
    print("| system | slice | side of the window | pixels with the same fate | robust pixels | largest difference of times |")
    print("|---|---|---|---|---|---|")
    chance = np.random.default_rng(1)
    for name in SYSTEMS:
        system = System(name)
        specs = list(random_specs(system, chance, ZOOMS))
        with tempfile.TemporaryDirectory() as folder:
            pictures = run_views(system, specs, Path(folder))
        for spec, found in zip(specs, pictures, strict=True):
            report(name, spec, np.array(found["fate"]), np.array(found["time"], float))


def report(name: str, spec: MapSpec, fate: np.ndarray, time: np.ndarray) -> None:
    """Print a row: how many of all pixels and of robust pixels have the same fate, and the largest difference of times.

    Robust pixels are not doubtful. The times are those of robust pixels that escape.
    """
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
