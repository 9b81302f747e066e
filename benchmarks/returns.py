"""How many orbits of rotating systems come back after they have left through an exit. Run: python -m benchmarks.returns

Random starts inside are followed to an exit, and from there without exits until they are far away or turn back: an orbit has come
back if it is inside its exit by more than the width of the Lyapunov orbit before it is `FAR` distances of the saddle away.
"""

from __future__ import annotations

import numpy as np

from engine import LyapunovOrbit, Potential, System, classify_orbits, find_lyapunov_orbits, sample_orbits, sample_starts
from engine.potentials.catalogue.rotating_systems import ROTATING_ENTRIES
from engine.potentials.outcomes import Centre
from engine.potentials.review.potential_review import review_system
from engine.taylor.kernels.events import exit_distance

STARTS, FAR = 600, 3.0
# Radius of collision of bodies outside the exits.
SMALL = 1e-3
# In natural units of time: until the exit, and after it; times of the latter.
UNTIL, AFTER, TIMES = 200.0, 60.0, 1200
# Shares of the range of energies above the escape energy.
SHARES = (0.1, 0.5, 0.9)


def count_returns(potential: Potential, orbit: LyapunovOrbit, states: np.ndarray) -> int:
    """Of states (n, 4) on an exit, those that come back."""
    times = np.linspace(0.0, AFTER * potential.well.exact_time_unit, TIMES)
    saddle = potential.saddles[orbit.channel - 1]
    width = np.ptp(np.column_stack([orbit.x, orbit.y]) @ saddle) / np.hypot(*saddle)
    # Without exits: collisions and a large escape radius only.
    others = [Centre(x, y, SMALL) for x, y in potential.form.singular_points.tolist() if x or y]
    open_system = potential.with_outcomes([*potential.centres, *others], 10.0 * FAR * float(np.hypot(*saddle)))
    paths = sample_orbits(open_system, states, times)
    returns = 0
    for x, y in zip(paths.x, paths.y, strict=True):
        distance = np.array([exit_distance(a, b, orbit.curve) for a, b in zip(x, y, strict=True)])
        far = np.flatnonzero(np.hypot(x, y) > FAR * np.hypot(*saddle))
        end = far[0] if far.size else len(x)
        returns += bool(np.any(distance[:end] < -width))
    return returns


def exit_states(potential: Potential, energy: float) -> list[tuple[LyapunovOrbit, np.ndarray]]:
    """For each exit its orbit and the states (n, 4) of random orbits that leave through it."""
    starts = sample_starts(potential, energy, STARTS, seed=1)
    outcomes = classify_orbits(potential, energy, starts, UNTIL * potential.well.exact_time_unit)
    found = []
    for orbit in find_lyapunov_orbits(potential, energy):
        leaving = np.flatnonzero(outcomes.fate == orbit.channel)
        just_before = outcomes.escape_time[leaving, None] - 1e-9 * potential.well.exact_time_unit
        paths = sample_orbits(potential, starts[leaving], just_before)
        found.append((orbit, np.column_stack([paths.x[:, 0], paths.y[:, 0], paths.px[:, 0], paths.py[:, 0]])))
    return found


def main() -> None:
    """Print a table."""
    print("| system | h | left | came back |\n|---|---|---|---|")
    for entry in ROTATING_ENTRIES:
        system = System(entry.name)
        potential, high = system.potential, review_system(system).energies.high
        for share in SHARES if potential.channels else ():
            energy = potential.escape_energy + share * (high - potential.escape_energy)
            exits = exit_states(potential, energy)
            left, back = sum(len(states) for _, states in exits), sum(count_returns(potential, *each) for each in exits)
            print(f"| {entry.title} | {energy:.6g} | {left} | {back} |")


if __name__ == "__main__":
    main()
