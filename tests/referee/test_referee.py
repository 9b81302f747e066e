"""Compare the engine with own integrations on examples and on some random formulas. `python -m tests.referee` compares many."""

from __future__ import annotations

import pytest

from tests.referee.checks import CHECKS, check_formula
from tests.referee.formulas import EXAMPLES, GRAMMARS, REPEATS, random_formula
from tests.referee.report import COMPARED, Report

# First seeds of structures of each grammar. The formulas of a structure share compiled functions.
STRUCTURES = {name: k for k, name in enumerate(GRAMMARS)}
CHEAP = ("exits", "fates", "images", "openness")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", EXAMPLES)
def test_answers_on_an_example_are_right(name: str) -> None:
    checks = tuple(check for check in CHECKS if check != "spellings")
    report = check_formula(EXAMPLES[name], seed=0, checks=checks)
    assert not report.wrong


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wells in an open channel", "rational channel", "Morse bond", "large constant", "closed well"])
def test_spellings_of_an_example_have_equal_reviews(name: str) -> None:
    report = check_formula(EXAMPLES[name], seed=0, energies=0, checks=("spellings",))
    assert not report.wrong


@pytest.mark.slow
@pytest.mark.parametrize("grammar", GRAMMARS)
def test_answers_on_random_formulas_are_right(grammar: str) -> None:
    report = Report()
    for k in range(2 * REPEATS):
        seed = REPEATS * (STRUCTURES[grammar] + len(GRAMMARS) * (k // REPEATS)) + k % REPEATS
        report.merge(check_formula(random_formula(seed), seed, checks=CHEAP))
    assert not report.wrong
    assert sum(number for (_, result, _), number in report.counts.items() if result == COMPARED) > 100
