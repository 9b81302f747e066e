"""Compare a formula with its other spellings: nested, expanded, with turned or moved axes, in other units, about its well."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import sympy

from engine import FormulaError, find_lyapunov_orbits, review_potential
from engine.results import PotentialReview
from tests.referee.formulas import REPEATS, Formula, X, Y
from tests.referee.images import compare_outcomes, exit_images, image_of
from tests.referee.report import REFUSED, UNDECIDED, Report
from tests.referee.setting import Setting

CHECK = "spellings"
STARTS = 30
_FACTOR = sympy.Rational(17, 10)
_LARGE_FACTOR = 50
_ORIGIN = sympy.Rational(-13, 10), sympy.Rational(7, 10)
_SAME = np.eye(2)
# Distance of neighbouring energies in depths of the well above which the exits of a spelling may be refused.
_FEW_DIGITS = 1e-6


@dataclass(frozen=True)
class Spelling:
    """A formula written anew, the matrix that maps places, the new origin, and the factor by which times are longer."""

    spell: Callable[[sympy.Expr], sympy.Expr]
    matrix: np.ndarray = None  # type: ignore[assignment]
    time_factor: float = 1.0
    at_well: bool = False
    origin: tuple[float, float] = (0.0, 0.0)

    def apply(self, formula: Formula) -> Formula:
        text = sympy.sstr(self.spell(formula.expression)).replace("**", "^")
        place = (0.0, 0.0) if self.at_well and formula.well is None else formula.well
        well = None if place is None else tuple((self._matrix @ (np.array(place) - self.origin)).round(12).tolist())
        return replace(formula, expression_text=text, well=well, state=None)

    @property
    def _matrix(self) -> np.ndarray:
        return _SAME if self.matrix is None else self.matrix

    def images(self, states: np.ndarray) -> np.ndarray:
        """Return the images of states; momenta are turned but not scaled, because the energies are equal."""
        images = image_of(states, self._matrix)
        images[:, 2:] *= np.sqrt(abs(1.0 / np.linalg.det(self._matrix)))
        return images


def _nested(expression: sympy.Expr) -> sympy.Expr:
    return sympy.horner(expression, X, Y) if expression.is_polynomial(X, Y) else sympy.together(expression)


def _exchanged(x: sympy.Expr, y: sympy.Expr) -> Callable[[sympy.Expr], sympy.Expr]:
    return lambda expression: expression.subs({X: x, Y: y}, simultaneous=True)


SPELLINGS: dict[str, Spelling] = {
    "expanded": Spelling(sympy.expand),
    "nested": Spelling(_nested),
    "swapped axes": Spelling(_exchanged(Y, X), np.array([[0.0, 1.0], [1.0, 0.0]])),
    "turned axes": Spelling(_exchanged(Y, -X), np.array([[0.0, -1.0], [1.0, 0.0]])),
    "other units": Spelling(_exchanged(_FACTOR * X, _FACTOR * Y), _SAME / float(_FACTOR), 1.0 / float(_FACTOR)),
    "small units": Spelling(
        _exchanged(_LARGE_FACTOR * X, _LARGE_FACTOR * Y), _SAME / float(_LARGE_FACTOR), 1.0 / float(_LARGE_FACTOR)
    ),
    "about its well": Spelling(lambda expression: expression, at_well=True),
    "moved axes": Spelling(
        lambda expression: sympy.expand(_exchanged(X + _ORIGIN[0], Y + _ORIGIN[1])(expression)),
        at_well=True,
        origin=(float(_ORIGIN[0]), float(_ORIGIN[1])),
    ),
}
"""Spellings by name."""


def check_spellings(formula: Formula, review: PotentialReview, energies: list[float], seed: int, report: Report) -> None:
    """Compare the reviews of all spellings, and the fates of one spelling."""
    names = [name for name, spelling in SPELLINGS.items() if not spelling.at_well or review.refusal is None]
    # Formulas of the same structure share the compiled functions of a spelling.
    chosen = random.Random(f"spelling {seed // REPEATS}").choice(names)
    for name in names:
        spelling = SPELLINGS[name]
        try:
            other_formula = spelling.apply(formula)
            other = review_potential(other_formula.parse())
        except FormulaError as error:
            report.add(CHECK, REFUSED, f"{name}: {error}")
            continue
        except Exception as error:
            known = {"spelling": name, "formula": formula.text, "spelled": other_formula.text, "error": repr(error)}
            report.add_wrong(CHECK, "the review of a spelling raises an error", **known)
            continue
        if _check_reviews(review, other, name, formula, other_formula, report) and name == chosen and review.refusal is None:
            for energy in energies:
                settings = Setting(formula, review.potential, energy), Setting(other_formula, other.potential, energy)
                _check_fates(*settings, spelling, name, seed, report)


def _check_reviews(
    review: PotentialReview, other: PotentialReview, name: str, formula: Formula, other_formula: Formula, report: Report
) -> bool:
    """Return whether two reviews agree."""
    known = {"spelling": name, "formula": formula.text, "spelled": other_formula.text}
    refusals = review.refusal, other.refusal
    accepted = (refusals[0] is None) == (refusals[1] is None)
    if not accepted and any("is not decided within" in (refusal or "") for refusal in refusals):
        report.add(CHECK, UNDECIDED, "one spelling needs more work than the limit")
        return False
    report.judge(CHECK, "one spelling is refused", accepted, **known, refusals=refusals)
    if not accepted or review.refusal is not None:
        return False
    unknown = [bool(each.potential.well.exits_unknown) for each in (review, other)]
    if any(unknown):
        report.add(CHECK, UNDECIDED, "the exits of a spelling are said to be unknown")
        return all(unknown)
    counts = _common_counts(review, other)
    same = counts[0] == counts[1]
    report.judge(CHECK, "the number of exits differs", same, **known, channels=counts)
    if not (review.channels and other.channels):
        return same
    heights = [each.potential.well.depth for each in (review, other)]
    alike = abs(heights[0] - heights[1]) <= 1e-9 * heights[0] + 1e-14 * abs(review.escape_energy)
    report.judge(CHECK, "the escape energy differs", alike, **known, heights=heights)
    return same and alike


def _common_counts(review: PotentialReview, other: PotentialReview) -> list[int]:
    """Return the numbers of exits in the smaller of the regions that were searched, given by their farthest critical points."""
    distances, reaches = [], []
    for potential in (review.potential, other.potential):
        points = np.hypot(*potential.critical_points.T)
        nearest = points[points > 0.0].min(initial=np.inf)
        distances.append(np.hypot(*potential.saddles.T) / nearest)
        reaches.append(points.max() / nearest)
    return [int(np.count_nonzero(each <= min(reaches) * (1.0 + 1e-9))) for each in distances]


def _check_fates(setting: Setting, other: Setting, spelling: Spelling, name: str, seed: int, report: Report) -> None:
    refusals = []
    for each in (setting, other):
        try:
            find_lyapunov_orbits(each.potential, each.energy)
        except ValueError as error:
            refusals.append(str(error))
    if len(refusals) == 2:
        report.add(CHECK, UNDECIDED, "exits refused in both spellings")
        return
    if refusals and np.spacing(setting.energy) > _FEW_DIGITS * setting.potential.well.depth:
        report.add(CHECK, UNDECIDED, "exits refused in one spelling, but the energy has few digits beside the constant of V")
        return
    known = {"spelling": name, "spelled": other.formula.text, "refusals": refusals}
    report.judge(CHECK, "the exits of one spelling are refused", not refusals, **known, **setting.reproduction)
    if refusals:
        return
    states = setting.random_starts(STARTS, seed)
    if len(states):
        fates = exit_images(setting, spelling._matrix, other.potential, other.energy)
        images = spelling.images(states)
        compare_outcomes(
            setting, other, states, images, fates, spelling.time_factor, CHECK, f"{name}: {other.formula.text}", report
        )
