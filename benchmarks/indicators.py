"""Verdicts of the chaos indicators at t = 1e3 and 1e5 on orbits that are bounded until 1e5, and whose character is known.

An orbit is taken as regular if its averages agree to 8 digits at some window, and as chaotic if its SALI is 1e-7 by 1e6.

Run: uv run python -m benchmarks.indicators
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from engine import (
    CASES,
    CHAOS_THRESHOLD,
    Fate,
    MapSpec,
    Plane,
    Potential,
    Verdict,
    compute_birkhoff_digits,
    compute_map,
    evaluate_indicators,
    integrate_orbit,
)

MAPS = (
    ("I", 0.13), ("I", 0.15), ("I", 0.17), ("II", 0.17), ("II", 0.18),
    ("III", 0.26), ("III", 0.28), ("III", 0.3), ("III", 0.35), ("III", 0.45),
)  # fmt: skip
SIDE, ORBITS = 60, 30
TIMES = (1e3, 1e5)
LONGEST_WINDOWS, LONGEST_TIME = 1.28e5, 1e6
CERTIFIED_DIGITS = 8.0


def bounded_starts() -> Iterator[tuple[Potential, np.ndarray]]:
    """Some bounded starts of each map."""
    random = np.random.default_rng(0)
    for case, energy in MAPS:
        spec = MapSpec(CASES[case], Plane.X_PX, energy, (SIDE, SIDE))
        whole = compute_map(spec)
        pixels = random.permutation(np.flatnonzero(whole.fate == Fate.BOUNDED))[:ORBITS]
        for state in spec.start_states(*whole.coordinates(pixels)):
            yield spec.potential, state


def known_character(potential: Potential, state: np.ndarray) -> Verdict:
    digits = compute_birkhoff_digits(potential, state, LONGEST_WINDOWS).digits
    if digits.size and digits[-1] >= CERTIFIED_DIGITS:
        return Verdict.REGULAR
    # Most chaotic orbits show it by the first time, which is faster to compute.
    smallest = (integrate_orbit(potential, state, t_max).sali.min() for t_max in (TIMES[-1], LONGEST_TIME))
    return Verdict.CHAOTIC if any(sali <= CHAOS_THRESHOLD for sali in smallest) else Verdict.UNDECIDED


def main() -> None:
    characters: Counter[Verdict] = Counter()
    verdicts: Counter[tuple[float, str, Verdict, Verdict | None]] = Counter()
    for potential, state in bounded_starts():
        character = known_character(potential, state)
        characters[character] += 1
        for t_max in TIMES:
            orbit, digits = integrate_orbit(potential, state, t_max), compute_birkhoff_digits(potential, state, t_max)
            for indicator in evaluate_indicators(orbit, digits):
                # No sign of chaos is all that deviation vectors can say of a regular orbit.
                found = Verdict.REGULAR if indicator.conclusion is Verdict.NO_SIGN else indicator.conclusion
                verdicts[t_max, indicator.name, character, found] += 1
    known = {Verdict.REGULAR: Verdict.CHAOTIC, Verdict.CHAOTIC: Verdict.REGULAR}
    print(f"{characters.total()} orbits, {characters[Verdict.UNDECIDED]} of them of unknown character\n")
    print(f"| right/undecided/wrong at | {' | '.join(f'{characters[one]} {one}' for one in known)} |\n|---|---|---|")
    for t_max, name in sorted({key[:2] for key in verdicts}):
        cells = (
            "/".join(str(verdicts[t_max, name, one, found]) for found in (one, Verdict.UNDECIDED, other))
            for one, other in known.items()
        )
        print(f"| t = {t_max:g}: {name} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
