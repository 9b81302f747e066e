"""Reviews accept unusual wells, and refuse others with a reason."""

from __future__ import annotations

import time

import pytest

from engine import parse_formula
from engine.systems.known_potentials import POTENTIALS
from engine.systems.potential import Potential
from engine.systems.review.classified_points import PointKind
from engine.systems.review.potential_review import review_potential
from tests.channel_family import channel_family


@pytest.mark.parametrize(
    ("formula", "reason"),
    [
        ("x²y²", "along a curve"),
        ("−r²/2", "a maximum there"),
        ("xy", "a saddle there"),
        ("x² + y⁴", "a degenerate point there"),
        ("x + r²", "linear terms"),
        ("½x² + ½y²/(1 + y²) + ½y² exp(−(y + 2)²)", "The well is open below its lowest saddle"),
        ("1 + x²y² exp(−r²)", "The force vanishes along a curve"),
        ("x² exp(−y) sin(1 + x)²", "The force vanishes along a curve"),
    ],
)
def test_invalid_potentials_are_refused_with_the_reason(formula: str, reason: str) -> None:
    refusal = review_potential(parse_formula(formula)).refusal
    assert refusal is not None
    assert reason in refusal


@pytest.mark.parametrize(
    "formula",
    [
        # V rises to +∞ on x = −0.2, where L_z keeps orbits away from the axis of a galaxy.
        "½log(x² + y²/0.81) + 0.02/x²; well (0.2, 0)",
        "½log(x² + y²/0.81) + 0.02/x²; well (0.2, 0); escape 20",
        "−1/(1 + √(1 + r²)) + 0.05/x²; well (0.5, 0); escape 30",
        # Repulsive centres.
        "1/r + x²; escape 5",
        "−log(r); escape 5",
    ],
)
def test_an_infinite_wall_is_no_gap(formula: str) -> None:
    assert review_potential(parse_formula(formula)).refusal is None


@pytest.mark.parametrize(
    ("formula", "reason"),
    [
        ("1/x + x² + y²; escape 5", "V is not defined along a curve"),
        ("−1/x² + y²; escape 5", "V is not defined along a curve"),
        ("log(1 − x) + y²; escape 3", "V is not defined along a curve"),
        ("−1/r; escape 5", "V is not defined at (0, 0)"),
        ("−1/(1 + r); escape 50", "The slope of V is not defined at (0, 0)"),
        ("−log(1 + r)/r; escape 50", "The slope of V is not defined at (0, 0)"),
    ],
)
def test_places_where_v_is_singular_are_refused_with_the_reason(formula: str, reason: str) -> None:
    assert str(review_potential(parse_formula(formula)).refusal).startswith(reason)


@pytest.mark.parametrize("formula", ["r²/2", "x² + y² + 0.1x²y²", "−1/√(r² + 1)", "exp(6x + 7y) + exp(6x − 7y) + exp(−12x) − 3"])
def test_wells_without_exits_are_accepted_with_energies_at_which_they_are_closed(formula: str) -> None:
    review = review_potential(parse_formula(formula))
    assert review.refusal is None
    assert "is shown to be closed up to h" in review.remarks[0]
    assert review.potential.well.bottom < review.energies.low < review.energies.first < review.energies.high
    assert review.energies.high < review.closed_energy


def test_exits_that_are_not_known_are_not_said_to_be_missing() -> None:
    remark = review_potential(parse_formula("exp(2000x) + exp(−2000x) + exp(2000y) + exp(−2000y)")).remarks[0]
    assert remark.startswith("The exits are not known: Whether all critical points")


@pytest.mark.parametrize(
    ("formula", "is_even"),
    [
        ("−1/√(x² + (y − 0.3)² + 0.5) − 1/√(x² + (y + 0.3)² + 0.5)", True),
        ("−1/√(x² + (y − 0.3)² + 0.5) − 1.01/√(x² + (y + 0.3)² + 0.5); well (0, 0)", False),
        ("exp(x + 2y) + exp(x − 2y) + exp(−2x)", True),
        ("r²/2 + 0.1y² sin(y)", False),
    ],
)
def test_v_is_even_also_if_the_reflection_exchanges_its_terms(formula: str, is_even: bool) -> None:
    review = review_potential(parse_formula(formula))
    assert (review.refusal, review.mirror_in_y) == (None, is_even)
    assert any(remark.startswith("V is not even in y") for remark in review.remarks) is not is_even


@pytest.mark.parametrize(
    ("formula", "wells"),
    [
        ("½x² − 2/(1 + (y − 2)²) − 2/(1 + (y + 2)²); well (0, 2)", "(0, −3.97204)"),
        # Four of twelve wells are next to that at the origin.
        ("sin(x)² + sin(y)²", "(0, −3.14159), (−3.14159, 0), (3.14159, 0), (0, 3.14159)"),
        # The mirror image of the well is behind the wall x = 0.
        ("½log(x² + y²/0.81) + 0.02/x² − 0.05y⁴; well (0.2, 0)", ""),
    ],
)
def test_only_wells_into_which_exits_lead_are_named(formula: str, wells: str) -> None:
    remarks = " ".join(review_potential(parse_formula(formula)).remarks)
    expected = f"Exits lead into other wells, at {wells}: an orbit that enters one counts as escaped but may return."
    assert (expected in remarks) == bool(wells)
    assert ("other wells" in remarks) == bool(wells)


@pytest.mark.parametrize(
    ("name", "is_said"), [("I", True), ("III", True), ("C8", True), ("Barbanis", True), ("Copenhagen", False)]
)
def test_parameters_that_only_change_the_units_are_named(name: str, is_said: bool) -> None:
    assert ("only change the units" in " ".join(review_potential(POTENTIALS[name]).remarks)) == is_said


def test_parameters_that_change_the_pictures_are_not_said_to_change_the_units() -> None:
    assert "only change the units" not in " ".join(review_potential(parse_formula("½(x² + y²) − xy² + 0.1x⁴")).remarks)


@pytest.mark.parametrize(
    ("formula", "well"),
    [
        ("((x−1)² + y²)/2 − (x−1)y²", (1.0, 0.0)),
        ("x + r²", (-0.5, 0.0)),
        # The nearer of two minima, at x = −1 and x = 2.
        ("y²/2 + x⁴/4 − x³/3 − x²", (-1.0, 0.0)),
        ("r²/2", None),
    ],
)
def test_the_nearest_well_elsewhere_is_offered(formula: str, well: tuple[float, float] | None) -> None:
    assert review_potential(parse_formula(formula)).well == well


def test_degenerate_point_outside_the_well_is_refused() -> None:
    # V_x = x (1 − x)² touches 0 at x = 1.
    refusal = review_potential(parse_formula("y²/2 + x²/2 − 2x³/3 + x⁴/4")).refusal
    assert refusal is not None
    assert "degenerate critical point at (1, 0)" in refusal


@pytest.mark.parametrize(
    "formula", ["½(x − 0.1y²)² − ⅓(x − 0.1y²)³ + 0.005y²", "½(x − 0.4133y³)² − 0.5452(x − 0.4133y³)⁴ + 0.0059y²"]
)
def test_points_that_the_rounding_of_coefficients_makes_far_away_are_no_reason_to_refuse(formula: str) -> None:
    # In u = x − g(y) and y, V is separable, so its only critical points are near the origin. Rounding of the terms adds others.
    review = review_potential(parse_formula(formula))
    assert any(point.kind is PointKind.DEGENERATE for point in review.critical_points)
    assert review.refusal is None


def test_a_refused_potential_has_no_energies_to_explore() -> None:
    review = review_potential(parse_formula("½(x² + 2y²) − x³/3 − xy²"))
    with pytest.raises(ValueError, match=r"energies: not defined for a refused potential\. V has a degenerate"):
        _ = review.energies


@pytest.mark.parametrize("n", [5, 8])
def test_the_family_has_its_symmetries(n: int) -> None:
    review = review_potential(channel_family(n))
    assert (review.mirror_in_x, review.mirror_in_y, review.rotations) == (n % 2 == 0, True, n)


def test_a_far_saddle_in_a_narrow_valley_is_reviewed() -> None:
    # The saddle is 27 000 units away, and the curvatures across and along the valley have the ratio 550.
    terms = (
        *((2, 0, 0.5303), (0, 2, 0.7672), (1, 1, -0.1449), (2, 1, -0.4607), (1, 4, -0.0938), (1, 3, -0.2776), (0, 5, -0.0645)),
        *((3, 0, 0.3398), (4, 0, 0.3995), (2, 3, -0.2132), (0, 4, 0.0443), (1, 2, -0.7503), (3, 2, 0.0155)),
    )
    review = review_potential(Potential("", terms))
    assert [point.channel for point in review.critical_points] == [0, 1, 2]


def test_maximum_between_two_exits_sets_the_highest_energy() -> None:
    # In u = x + y and v = x − y, V = ¼(u² + v²) + (u³ + v³)/6: the exits merge at the maximum u = v = −1, at energy 1/6.
    assert review_potential(POTENTIALS["Separable"]).highest_energy == pytest.approx(1 / 6, rel=1e-12)


@pytest.mark.parametrize("formula", ["(x²y² − 1)² + (x − y)²", "(r² − 1)²(r² − 4)²/50 + x²/9"])
def test_review_is_fast(formula: str) -> None:
    potential = parse_formula(formula)
    begin = time.process_time()
    review_potential(potential)
    assert time.process_time() - begin < 3.0


@pytest.mark.parametrize(
    ("terms", "channels", "escape_energy"),
    [
        # Saddles at x = −1 and 150.
        (((2, 0, 0.5), (0, 2, 0.5), (3, 0, (1 - 1 / 150) / 3), (4, 0, -1 / 600)), 2, 1 / 6 + 1 / 1800),
        # A well 140 times as long as wide.
        (((2, 0, 0.5), (0, 2, 0.5), (1, 1, -0.9999), (2, 2, -1.0)), 4, 2.5e-9),
        # Saddles at (0, 1/9) and (33.3, 0).
        (((2, 0, 0.5), (0, 2, 0.5), (3, 0, -0.01), (0, 3, -3.0)), 2, 1 / 486),
        # ½y² + ½x²(1 − xy)² tends to 0 along xy = 1, where rounding errors exceed its slope.
        (((0, 2, 0.5), (2, 0, 0.5), (3, 1, -1.0), (4, 2, 0.5)), 2, 0.25),
    ],
    ids=["far apart", "narrow", "far saddle", "valley"],
)
def test_unusual_wells_are_accepted_with_all_exits(
    terms: tuple[tuple[int, int, float], ...], channels: int, escape_energy: float
) -> None:
    review = review_potential(Potential("", terms))
    assert review.refusal is None
    assert review.channels == channels
    assert review.escape_energy == pytest.approx(escape_energy, rel=1e-9)
