"""All maps of the paper (three cases, two planes, nine energies) at 224 x 224 and t_max = 1e5: time and certificates.

Run: uv run python -m benchmarks.all_maps            # time all; then the five slowest without certificates
     uv run python -m benchmarks.all_maps --validate # 61 x 61, with and without certificates
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from engine import CASES, Certificate, EscapeMap, Fate, MapSpec, Plane, compute_map
from engine.execution import DEFAULT_EXECUTION
from engine.potentials.catalogue.table import PAPER_ENERGIES

SLOWEST = 5
EARLY = [code for code in Certificate if code > Certificate.INTEGRATED]


def specs(resolution: int) -> Iterator[MapSpec]:
    for case, energies in PAPER_ENERGIES.items():
        for plane in (Plane.X_PX, Plane.X_Y):
            for energy in energies.marked:
                yield MapSpec(CASES[case], plane, energy, (resolution, resolution), t_max=1e5)


def time_map(spec: MapSpec) -> tuple[float, EscapeMap]:
    begin = time.perf_counter()
    result = compute_map(spec)
    return time.perf_counter() - begin, result


def shares(result: EscapeMap) -> str:
    """Bounded share of the interior, then the share of each certificate among the bounded orbits."""
    bounded = result.fate == Fate.BOUNDED
    kinds = [np.count_nonzero(result.certificate[bounded] == code) / max(bounded.sum(), 1) for code in Certificate if code]
    return " | ".join(f"{share:.1%}" for share in (bounded.sum() / result.interior.sum(), *kinds))


def title(spec: MapSpec) -> str:
    return f"{spec.potential.name} | {spec.plane.title} | {spec.energy}"


def time_all() -> None:
    """Print the times of all maps, and of the slowest ones without certificates."""
    print(f"224 x 224, t_max = 1e5, {DEFAULT_EXECUTION.workers} threads\n")
    names = " | ".join(code.name.lower().replace("_", "-") for code in Certificate if code)
    print(f"| case | plane | h | seconds | bounded | {names} | worst energy error |\n|{'---|' * (11)}")
    times = {}
    for spec in specs(224):
        compute_map(replace(spec, resolution=(20, 20), t_max=1000.0))
        times[spec], result = time_map(spec)
        print(f"| {title(spec)} | {times[spec]:.1f} | {shares(result)} | {result.worst_energy_error:.1e} |", flush=True)
    print()
    print("| case | plane | h | with certificates, s | without, s | ratio | differing fates |\n|---|---|---|---|---|---|---|")
    for spec in sorted(times, key=lambda spec: -times[spec])[:SLOWEST]:
        seconds, whole = time_map(replace(spec, certify=False))
        differ = np.count_nonzero(whole.fate != compute_map(spec).fate)
        print(f"| {title(spec)} | {times[spec]:.1f} | {seconds:.1f} | {seconds / times[spec]:.1f} | {differ} |", flush=True)


def validate() -> None:
    """Count certified orbits that escape when they are integrated to t_max."""
    print("| case | plane | h | bounded | certified early | wrong | escape after t = 1000 |\n|---|---|---|---|---|---|---|")
    totals = np.zeros(4, int)
    for spec in specs(61):
        certified, whole = compute_map(spec), compute_map(replace(spec, certify=False))
        early = np.isin(certified.certificate, EARLY)
        late = whole.escape_time > 1000.0
        counts = np.array([np.sum(whole.fate == Fate.BOUNDED), early.sum(), np.sum(early & (whole.fate >= 1)), late.sum()])
        assert np.array_equal(certified.fate[~early], whole.fate[~early])
        totals += counts
        print(f"| {title(spec)} | {' | '.join(map(str, counts))} |", flush=True)
    print(f"| all | | | {' | '.join(map(str, totals))} |")


if __name__ == "__main__":
    validate() if "--validate" in sys.argv else time_all()
