"""Common factors of the slopes of potentials, found before any root is."""

from __future__ import annotations

import numpy as np
import pytest

from engine import channel_family, parse_formula
from engine.potentials.forms.common_factor import have_common_factor
from tests.contracts.potentials import WELLS

HENON_HEILES = "(x²/2 + y²/2 + x²y − y³/3)"


def circular(seed: int) -> str:
    """V(r), with the rounding errors of its expanded coefficients."""
    random = np.random.default_rng(seed)
    powers = random.choice(np.arange(4, 13, 2), random.integers(1, 5), replace=False)
    return "r^2/2" + "".join(f" {random.choice(list('+-'))} {random.uniform(0.01, 3.0):.3f}r^{power}" for power in powers)


def composite(seed: int) -> str:
    """h + c h³ of a cubic polynomial h, whose gradient is (1 + 3c h²) ∇h."""
    a, b, c = np.random.default_rng(seed).uniform(0.1, 2.0, 3)
    h = f"({a:.4f}x² + {b:.4f}y² − xy²)"
    return f"{h} − {c:.4f}{h}^3"


@pytest.mark.parametrize("formula", [*map(circular, range(40)), *map(composite, range(20)), "x²y²", "(x − y)²(x + 1)"])
def test_a_common_factor_is_found(formula: str) -> None:
    assert have_common_factor(*parse_formula(formula).form.slopes)


def test_a_common_factor_is_one_in_any_unit_of_length() -> None:
    assert have_common_factor(*parse_formula("1000r² + 0.001r⁶ − 0.000001r^12").form.slopes)


@pytest.mark.parametrize("name", WELLS)
@pytest.mark.parametrize("parameters", [(1.0, 1.0, 1.0), (10.0, 0.1, 100.0), (0.1, 0.1, 0.01)])
def test_the_catalogue_has_none(name: str, parameters: tuple[float, float, float]) -> None:
    assert not have_common_factor(*WELLS[name].with_parameters(*parameters).form.slopes)


@pytest.mark.parametrize("n", range(3, 13))
def test_the_family_has_none(n: int) -> None:
    assert not have_common_factor(*channel_family(n).form.slopes)


def test_a_small_term_that_matters_far_away_is_not_a_rounding_error() -> None:
    # Circular up to r = 100; the last term opens the well.
    assert not have_common_factor(*parse_formula("2e-9r² + 4e8x⁴ + 8e8x²y² + 4e8y⁴ − 2e-9x^12").form.slopes)


def test_linear_slopes_have_none() -> None:
    assert not have_common_factor({(1, 0): 1.0}, {(0, 1): 1.0})
