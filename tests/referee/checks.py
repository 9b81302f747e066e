"""Apply all checks to one formula."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from engine import FormulaError, find_lyapunov_orbits, review_potential
from engine.results import PotentialReview
from tests.referee.descents import check_channels, check_exits
from tests.referee.fates import check_fates
from tests.referee.formulas import Formula
from tests.referee.images import check_images
from tests.referee.interior import check_interior
from tests.referee.openness import check_closed, check_openness
from tests.referee.own_orbits import UndecidedError
from tests.referee.report import COMPARED, REFUSED, UNDECIDED, Report
from tests.referee.returns import check_returns
from tests.referee.setting import Setting
from tests.referee.spellings import check_spellings
from tests.referee.verdicts import check_verdicts

LOWEST, HIGHEST = 1.01, 50.0
"""Energies in depths of the well above its bottom."""

# Energies of a verdict below the escape energy, as shares of the depth.
_BELOW = (0.05, 1.0)


def _check_channels(setting: Setting, _seed: int, report: Report) -> None:
    check_channels(setting, report)


OPEN_CHECKS: Mapping[str, Callable[[Setting, int, Report], None]] = {
    "exits": _check_channels,
    "fates": check_fates,
    "images": check_images,
    "interior": check_interior,
    "openness": check_openness,
    "returns": check_returns,
    "verdicts": check_verdicts,
}
"""Checks at an energy, by name."""

CHECKS = (*OPEN_CHECKS, "spellings")
"""Names of all checks."""


def random_energies(review: PotentialReview, count: int, seed: int) -> list[float]:
    """Return energies between `LOWEST` and `HIGHEST` escape energies, more of them near the lowest."""
    choice = random.Random(f"energies {seed}")
    low, high = math.log(LOWEST - 1.0), math.log(HIGHEST - 1.0)
    return [review.potential.well.energy_at(1.0 + math.exp(choice.uniform(low, high))) for _ in range(count)]


def check_formula(formula: Formula, seed: int, energies: int = 1, checks: tuple[str, ...] = CHECKS) -> Report:
    """Compare what the engine says about a formula at its own energies, or at random ones."""
    report = Report()
    for part in check_in_parts(formula, seed, energies, checks):
        report.merge(part)
    return report


def check_in_parts(formula: Formula, seed: int, energies: int, checks: tuple[str, ...]) -> Iterator[Report]:
    """Yield a report after each check."""
    report = Report()
    review = _review(formula, report)
    if review is not None and review.well is not None and formula.well is None:
        # There is no well at the origin, but one elsewhere.
        formula = replace(formula, well=review.well)
        review = _review(formula, report)
    if review is None:
        yield report
        return
    if "openness" in checks:
        check_closed(formula, review, seed, report)
    yield report
    chosen = list(formula.energies) or (random_energies(review, energies, seed) if review.refusal is None else [])
    if formula.state is not None:
        chosen.append(float(review.potential.energy(np.array(formula.state))))
    if review.refusal is None:
        yield from _check_accepted(Setting(formula, review.potential, review.escape_energy), chosen, seed, checks)
    if "spellings" in checks:
        report = Report()
        try:
            check_spellings(formula, review, chosen, seed, report)
        except UndecidedError as error:
            report.add("spellings", UNDECIDED, str(error))
        yield report


def _review(formula: Formula, report: Report) -> PotentialReview | None:
    """Return the review; None without one."""
    try:
        review = review_potential(formula.parse())
    except FormulaError as error:
        report.add("review", REFUSED, str(error))
        return None
    except Exception as error:
        report.add_wrong("review", "the review raises an error", formula=formula.text, error=repr(error))
        return None
    report.add("review", COMPARED if review.refusal is None else REFUSED, review.refusal or "")
    return review


def _check_accepted(setting: Setting, energies: list[float], seed: int, checks: tuple[str, ...]) -> Iterator[Report]:
    if "exits" in checks:
        report, unknown = Report(), setting.potential.well.exits_unknown
        if unknown:
            report.add("exits", REFUSED, unknown)
        else:
            check_exits(setting.potential, setting.system, setting.formula.text, report)
        yield report
    below = setting.potential.well.energy_at(random.Random(f"below {seed}").uniform(*_BELOW))
    yield from _check_at(setting.at(below), seed, tuple(name for name in checks if name in ("openness", "verdicts")))
    for energy in energies:
        yield from _check_at(setting.at(energy), seed, checks)


def _check_at(setting: Setting, seed: int, checks: tuple[str, ...]) -> Iterator[Report]:
    report = Report()
    try:
        find_lyapunov_orbits(setting.potential, setting.energy)
        report.add("energies", COMPARED)
    except ValueError as error:
        report.add("energies", REFUSED, str(error))
        checks = ()
    yield report
    for name in [name for name in OPEN_CHECKS if name in checks]:
        report = Report()
        try:
            OPEN_CHECKS[name](setting, seed, report)
        except UndecidedError as error:
            report.add(name, UNDECIDED, str(error))
        except ValueError as error:
            report.add(name, REFUSED, str(error))
        yield report
