"""Compare the engine with own integrations on examples and on some random formulas. `python -m tests.referee` compares many.

Compiling the functions of a formula takes most of the time, so each example is compared where it was once answered wrongly, and
the random formulas of a grammar share their structure.
"""

from __future__ import annotations

import pytest

from tests.referee.checks import check_formula
from tests.referee.ends import check_ends
from tests.referee.formulas import EXAMPLES, REPEATS, Formula, random_formula
from tests.referee.report import COMPARED, Report

CHECKS_OF_EXAMPLES = {
    "narrow valleys, even in y": ("images",),
    "chaos far above the unit of the well": ("verdicts",),
    "tori far above the unit of the well": ("verdicts",),
    "Morse bond": ("openness",),
    "rational channel": ("openness", "spellings"),
    "wells in an open channel": ("openness",),
    "turn beyond an exit": ("fates",),
    "bent well with an exit inside its bend": ("fates",),
    "periodic orbit through the bottom": ("exits", "fates"),
    "large constant": ("spellings",),
    "meridional plane": ("openness",),
    "sum of exponentials": ("openness",),
    "flat axes": ("openness",),
    "closed well": ("openness", "spellings"),
}
# Structures of each grammar, with accepted formulas.
STRUCTURES = (1, 2)
REVIEWED = 12
# A well, two bodies twice, and hills, all with arcs, and three with a mass and a rotating frame.
SEEDS_OF_ENDS = (2, 3, 12, 22)


def compared(report: Report) -> int:
    return sum(number for (_, result, _), number in report.counts.items() if result == COMPARED)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", EXAMPLES)
def test_answers_on_an_example_are_right(name: str) -> None:
    report = check_formula(EXAMPLES[name], seed=0, checks=CHECKS_OF_EXAMPLES[name])
    assert not report.wrong


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("structure", STRUCTURES)
def test_fates_on_random_formulas_are_right(structure: int) -> None:
    report = Report()
    for seed in range(REPEATS * structure, REPEATS * (structure + 1)):
        report.merge(check_formula(random_formula(seed), seed, checks=("fates", "images", "interior", "openness", "returns")))
    assert not report.wrong
    assert compared(report) > 50


@pytest.mark.slow
def test_ends_of_orbits_on_random_formulas_are_right() -> None:
    report = Report()
    for seed in SEEDS_OF_ENDS:
        check_ends(seed, 5, report)
    assert not report.wrong
    assert compared(report) > 50


@pytest.mark.exhaustive
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_narrow_valley_has_equal_reviews_in_all_spellings() -> None:
    formula = Formula(EXAMPLES["narrow valleys, even in y"].expression_text)
    report = check_formula(formula, seed=0, energies=0, checks=("spellings",))
    assert not report.wrong


@pytest.mark.exhaustive
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_reviews_of_random_formulas_in_other_spellings_are_equal() -> None:
    report = Report()
    for seed in range(0, REPEATS * REVIEWED, REPEATS):
        report.merge(check_formula(random_formula(seed), seed, energies=0, checks=("spellings",)))
    assert not report.wrong
    assert compared(report) > 100
