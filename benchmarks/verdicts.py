"""Count verdicts on single orbits and on pixels of maps that later turn out wrong, in ten chaotic seas with their islands.

Starts are uniform on the energy surface. Orbits that are bounded until t = 1000 are judged at several times up to 1e5. An orbit
counts as chaotic if, by t = 1e5, its SALI falls to 1e-7 or it escapes. Maps of (x, px) are judged at the same times.

Run: uv run python -m benchmarks.verdicts [orbits per sea, by default 200] [seed]
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

import numpy as np

from engine import (
    CASES,
    POTENTIALS,
    Fate,
    MapSpec,
    Orbit,
    Plane,
    Potential,
    Regularity,
    classify_orbits,
    compute_map,
    compute_regularity,
    integrate_orbit,
    judge_orbit,
    sample_starts,
)
from engine.propagation.fates import CHAOS_THRESHOLD
from engine.trajectories.chaos_indicators import Verdict

FIVE = POTENTIALS["C5"]
SEAS = (
    (CASES["I"], 0.125), (CASES["I"], 0.13), (CASES["I"], 0.136), (CASES["II"], 0.16), (CASES["II"], 0.168), (CASES["II"], 0.172),
    (CASES["III"], 0.25), (CASES["III"], 0.26), (CASES["III"], 0.28), (FIVE, 1.03 * FIVE.escape_energy),
)  # fmt: skip
TIMES = (1e3, 2e3, 4e3, 1e4, 2e4, 5e4, 1e5)
# Wrong verdicts: a character, and whether the orbit counts as chaotic.
WRONG = ((Verdict.REGULAR, True), (Verdict.CHAOTIC, False))
SIDE = 48
# Number of random starts per start that is bounded until the first time.
STARTS_PER_BOUNDED = 30


def bounded_starts(potential: Potential, energy: float, count: int, seed: int) -> np.ndarray:
    starts = sample_starts(potential, energy, STARTS_PER_BOUNDED * count, rng=seed)
    fates = classify_orbits(potential, energy, starts, t_max=TIMES[0]).fate
    return starts[fates == Fate.BOUNDED][:count]


def shortened(orbit: Orbit, t_end: float) -> Orbit:
    """Return the part of an orbit until a time at which the orbit is bounded."""
    count = int(np.searchsorted(orbit.t, t_end * (1.0 + 1e-12), side="right"))
    names = ("t", "x", "y", "px", "py", "sali", "lyapunov_exponent", "r2")
    return replace(orbit, fate=int(Fate.BOUNDED), **{name: getattr(orbit, name)[:count] for name in names})


def count_verdicts(potential: Potential, energy: float, count: int, seed: int) -> Counter[tuple[float, Verdict | None, bool]]:
    """Count orbits by time, by their verdict at this time, and by whether they count as chaotic."""
    counts: Counter[tuple[float, Verdict | None, bool]] = Counter()
    for state in bounded_starts(potential, energy, count, seed):
        orbit = integrate_orbit(potential, state, TIMES[-1])
        is_chaotic = orbit.fate != Fate.BOUNDED or bool(orbit.sali.min() <= CHAOS_THRESHOLD)
        for time in TIMES:
            # The factor allows for rounding of the last time.
            if time <= orbit.t[-1] * (1.0 + 1e-12):
                counts[time, judge_orbit(shortened(orbit, time)).character, is_chaotic] += 1
    return counts


def count_pixels(potential: Potential, energy: float) -> Counter[tuple[float, Regularity, bool]]:
    """Count pixels of a map by time, by character at this time, and by whether orbits are chaotic or escape by the last time."""
    characters = {}
    for time in TIMES:
        pixels = compute_map(MapSpec(potential, Plane.X_PX, energy, (SIDE, SIDE), t_max=time))
        characters[time] = compute_regularity(pixels).character
    chaotic = np.isin(characters[TIMES[-1]], (Regularity.CHAOTIC, Regularity.NOT_APPLICABLE))
    return Counter(
        (time, Regularity(int(code)), bool(later))
        for time, codes in characters.items()
        for code, later in zip(codes.ravel(), chaotic.ravel(), strict=True)
    )


def print_pixels() -> None:
    total: Counter[tuple[float, Regularity, bool]] = Counter()
    for potential, energy in SEAS:
        total += count_pixels(potential, energy)
    print("| t | regular, chaotic later | chaotic, not later | no sign of chaos, chaotic later |\n|---|---|---|---|")
    for time in TIMES:
        pairs = ((Regularity.REGULAR, True), (Regularity.CHAOTIC, False), (Regularity.NO_SIGN_OF_CHAOS, True))
        cells = [f"{total[time, v, True] + total[time, v, False]}, {total[time, v, later]}" for v, later in pairs]
        print(f"| {time:g} | {' | '.join(cells)} |")


def main(count: int = 200, seed: int = 2) -> None:
    total: Counter[tuple[float, Verdict | None, bool]] = Counter()
    for potential, energy in SEAS:
        found = count_verdicts(potential, energy, count, seed)
        total += found
        wrong = sum(found[time, verdict, chaotic] for time in TIMES for verdict, chaotic in WRONG)
        print(f"{potential.name} at h = {energy:g}: {wrong} wrong verdicts of {found.total()}", flush=True)
    print("| t | regular, wrong | chaotic, wrong | no sign of chaos, chaotic later | undecided |\n|---|---|---|---|---|")
    for time in TIMES:
        pairs = ((Verdict.REGULAR, True), (Verdict.CHAOTIC, False), (Verdict.NO_SIGN, True), (Verdict.UNDECIDED, True))
        cells = [f"{total[time, v, True] + total[time, v, False]}, {total[time, v, later]}" for v, later in pairs]
        print(f"| {time:g} | {' | '.join(cells)} |")
    print_pixels()


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
