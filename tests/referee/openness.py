"""Look for orbits that run away to infinity while the engine says that they are bounded, or that no orbit escapes."""

from __future__ import annotations

import numpy as np

from engine import Evidence, Fate, MapSpec, Plane, classify_orbits, compute_map, start_states
from engine.results import PotentialReview
from tests.referee.formulas import Formula
from tests.referee.own_orbits import UndecidedError
from tests.referee.report import REFUSED, UNDECIDED, Report
from tests.referee.setting import STEADY, Setting

CHECK = "openness"
# Number of starts, and duration in units of time. An orbit said to be bounded for ever is followed longer by a factor.
STARTS, DURATION, LONGER = 40, 1000.0, 3.0
# Energies in units of energy at which a well without exits is tested, as far as it is said to be closed.
CLOSED_ENERGIES = (1.0, 10.0, 100.0, 1e3, 1e4)


def check_openness(setting: Setting, seed: int, report: Report) -> None:
    """Bounded orbits, of random starts and of a map, do not run away."""
    t_max = DURATION * setting.time_unit
    starts = setting.random_starts(STARTS, seed + 1)
    if setting.is_start_of_example:
        starts = np.vstack([starts, setting.formula.state])
    if len(starts):
        found = classify_orbits(setting.potential, setting.energy, starts, t_max=t_max)
        for state in starts[found.fate == Fate.BOUNDED]:
            _judge(setting, state, t_max, "a bounded orbit runs away", report, ever=False)
    for state in _closed_starts(setting, t_max, report):
        _judge(setting, state, LONGER * t_max, "an orbit said to be bounded for ever runs away", report, ever=True)


def _closed_starts(setting: Setting, t_max: float, report: Report) -> np.ndarray:
    """Return starts of a small map that are said to be bounded for ever."""
    try:
        found = compute_map(MapSpec(setting.potential, Plane.X_PX, setting.energy, (5, 5), t_max=t_max))
    except ValueError as error:
        report.add(CHECK, REFUSED, str(error))
        return np.empty((0, 4))
    pixels = np.flatnonzero(found.evidence.ravel() == Evidence.CLOSED)
    return start_states(setting.potential, Plane.X_PX, setting.energy, *found.coordinates(pixels))


def _judge(setting: Setting, state: np.ndarray, duration: float, kind: str, report: Report, *, ever: bool) -> None:
    """An orbit does not leave for ever within a duration. Unless it never may, it must leave with a shifted start as well."""
    try:
        times = [setting.orbits.time_of_leaving(state, duration)]
        if np.isfinite(times[0]) and not ever:
            times.append(setting.orbits.time_of_leaving(setting.shifted(state[None])[0], duration))
    except UndecidedError as error:
        report.add(CHECK, UNDECIDED, str(error))
        return
    if len(times) == 2 and not abs(times[1] - times[0]) < STEADY * setting.time_unit:
        report.add(CHECK, UNDECIDED, "the fate changes with a shift of the start")
        return
    report.judge(CHECK, kind, not np.isfinite(times[0]), start=state.tolist(), time=times[0], **setting.reproduction)


def check_closed(formula: Formula, review: PotentialReview, seed: int, report: Report) -> None:
    """Launch orbits from the origin of a well without exits at energies at which it is said to be closed."""
    if review.refusal is not None or review.channels or not np.isfinite(review.closed_energy):
        return
    random, unit = np.random.default_rng(seed), review.potential.units.energy
    bottom = float(review.potential.value(0.0, 0.0))
    # V and the integrator do not depend on the energy.
    setting = Setting(formula, review.potential, bottom)
    energies = [*formula.energies, *(bottom + unit * multiple for multiple in CLOSED_ENERGIES), review.closed_energy]
    for energy in [each for each in energies if bottom < each <= review.closed_energy]:
        setting = setting.at(energy)
        for turn in [*(0.5 * np.pi * np.arange(4)), *random.uniform(0.0, 2.0 * np.pi, 6)]:
            momentum = np.sqrt(2.0 * (energy - bottom)) * np.array([np.cos(turn), np.sin(turn)])
            state = np.array([0.0, 0.0, *momentum])
            _judge(setting, state, 100.0 * setting.time_unit, "an orbit leaves a well said to be closed", report, ever=True)
