"""Axes move to a well elsewhere, so that potentials keep their authors' formulas and energies."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula, review_potential
from engine.systems.formulas.formula_parser import read_potential

CALDERA = "5(x² + y²) + 3y + 0.3(x⁴ + y⁴ − 6x²y²)"
MUELLER_BROWN = (
    "−200exp(−(x − 1)² − 10y²) − 100exp(−x² − 10(y − 0.5)²)"
    "− 170exp(−6.5(x + 0.5)² + 11(x + 0.5)(y − 1.5) − 6.5(y − 1.5)²) + 15exp(0.7(x + 1)² + 0.6(x + 1)(y − 1) + 0.7(y − 1)²)"
)
DE_LEON_BERNE = "10(1 − exp(−1.95x))² + 4y²(y² − 1) exp(−4.485x) + 1"


@pytest.mark.parametrize(
    ("formula", "well", "origin", "energies"),
    [
        # The saddles of the caldera with c₁ = 5, c₂ = 3 and c₃ = −0.3.
        (CALDERA, "(0, 0)", (0.0, -0.296861), [14.7669, 14.7669, 27.0123, 27.0123]),
        # Müller & Brown (1979, Theor. Chim. Acta 53, 75) state −40.665 and −72.249.
        (MUELLER_BROWN, "(−0.5, 1.4)", (-0.558224, 1.441726), [-40.6648]),
        (MUELLER_BROWN, "(0.6, 0)", (0.623499, 0.028038), [-72.2489]),
        (MUELLER_BROWN, "(0, 0.5)", (-0.050011, 0.466694), [-72.2489, -40.6648]),
    ],
)
def test_saddles_have_the_energies_that_authors_state(
    formula: str, well: str, origin: tuple[float, float], energies: list[float]
) -> None:
    potential = parse_formula(f"{formula}; well {well}")
    assert review_potential(potential).refusal is None
    np.testing.assert_allclose(potential.origin, origin, atol=1e-6)
    np.testing.assert_allclose(sorted(potential.well.saddle_energies), energies, atol=1e-4)


def test_the_lowest_exit_of_de_leon_and_berne_is_the_saddle_of_their_formula() -> None:
    potential = parse_formula(f"{DE_LEON_BERNE}; well (0, 0.7)")
    assert review_potential(potential).refusal is None
    # In the authors' formula the saddle is at (0, 0), with V = 1.
    assert potential.escape_energy == pytest.approx(1.0, abs=1e-14)
    lowest = potential.saddles[np.argmin(potential.well.saddle_energies)]
    np.testing.assert_allclose(lowest + potential.origin, 0.0, atol=1e-14)


def test_moved_axes_leave_v_at_each_place_unchanged() -> None:
    formula = MUELLER_BROWN
    typed, moved = parse_formula(formula), parse_formula(f"{formula}; well (0, 0)")
    x, y = np.random.default_rng(3).uniform(-0.7, 0.7, (2, 50))
    np.testing.assert_allclose(moved.value(x, y), typed.value(x + moved.origin[0], y + moved.origin[1]), rtol=1e-12, atol=1e-11)
    assert moved.critical_points[np.hypot(*moved.critical_points.T) < 1e-6].tolist() == [[0.0, 0.0]]


def test_a_well_is_found_far_beyond_a_critical_point_near_the_origin() -> None:
    # A minimum at (0.08, −0.007) makes the region small that is searched about the origin.
    wells = "−1.8118/(1 + (x + 0.143)² + (y + 1.909)²) − 1.5383/(1 + (x + 0.07)² + (y − 1.818)²) − 1.4043/(1 + (x − 0.102)² + y²)"
    for well, origin in [("(−0.07, 1.818)", (-0.060351, 1.689716)), ("(0, 0)", (0.080087, -0.007208))]:
        np.testing.assert_allclose(parse_formula(f"{wells}; well {well}").origin, origin, atol=1e-6)


def test_bodies_move_with_the_axes() -> None:
    moved = parse_formula("½(x − 1)² + ½y² − 0.1/√((x − 2)² + y²); center (2, 0) 0.01; well (1, 0); escape 5")
    (centre,) = moved.centres
    assert (centre.x + moved.origin[0], centre.y) == (2.0, 0.0)


def test_files_keep_the_origin() -> None:
    moved = parse_formula(f"{CALDERA}; well (0, 0)")
    read = read_potential(moved.provenance())
    assert (read, read.origin) == (moved, moved.origin)


@pytest.mark.parametrize("constant", [0.0, 1.0, 1e7])
def test_a_constant_has_no_effect_on_the_terms_of_moved_axes(constant: float) -> None:
    formula = "0.0001(½(x² + y²) + 0.05x³ − x²y²)"
    moved, expected = parse_formula(f"{constant} + {formula}; well (0, 0)"), parse_formula(formula)
    assert moved.channels == expected.channels
    # The rounding error of V is that of the constant.
    assert moved.escape_energy - constant == pytest.approx(expected.escape_energy, rel=1e-12, abs=4e-16 * constant)
