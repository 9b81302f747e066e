"""Count orbits that are called bounded on evidence but escape when they are integrated to t_max.

All maps of the paper are computed: three cases, two planes, nine energies.
Each map of 61 x 61 starts is computed with and without evidence.

Run: uv run python -m benchmarks.evidence
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from engine import CASES, Evidence, Fate, MapSpec, Plane, compute_map
from engine.systems.catalogue.table import PAPER_ENERGIES

SIDE = 61
T_MAX = 1e5
# Evidence that ends the integration before t_max.
EARLY = [code for code in Evidence if code > Evidence.INTEGRATED]


def specs() -> Iterator[MapSpec]:
    for case, energies in PAPER_ENERGIES.items():
        for plane in (Plane.X_PX, Plane.X_Y):
            for energy in energies.marked:
                yield MapSpec(CASES[case], plane, energy, (SIDE, SIDE), t_max=T_MAX)


def count_orbits(spec: MapSpec) -> np.ndarray:
    """Count bounded orbits, orbits bounded on evidence, escapes among orbits bounded on evidence, and escapes after t = 1000."""
    on_evidence, whole = compute_map(spec), compute_map(replace(spec, use_evidence=False))
    early = np.isin(on_evidence.evidence, EARLY)
    assert np.array_equal(on_evidence.fate[~early], whole.fate[~early])
    late = whole.escape_time > 1000.0
    return np.array([np.sum(whole.fate == Fate.BOUNDED), early.sum(), np.sum(early & (whole.fate >= 1)), late.sum()])


def main() -> None:
    print("| case | plane | h | bounded | on evidence | wrong | escape after t = 1000 |\n|---|---|---|---|---|---|---|")
    totals = np.zeros(4, int)
    for spec in specs():
        counts = count_orbits(spec)
        totals += counts
        title = f"{spec.potential.name} | {spec.plane.title} | {spec.energy}"
        print(f"| {title} | {' | '.join(map(str, counts))} |", flush=True)
    print(f"| all | | | {' | '.join(map(str, totals))} |")


if __name__ == "__main__":
    main()
