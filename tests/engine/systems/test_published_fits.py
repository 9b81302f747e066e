"""The published fits have the values of their formulas."""

from __future__ import annotations

import numpy as np
import pytest

from engine.systems.catalogue.published_fits import PAPER_FITS


# ½[1 + tanh u] = 1 / (1 + exp(−2u)).
@pytest.mark.parametrize(
    ("name", "energy", "twice_u"),
    [("I", 0.15, 1.0), ("I", 0.2, 4.0), ("II", 0.18, 4.64), ("III", 0.3, -0.35), ("III", 0.4, 2.82)],
)
def test_fits_of_escapes_have_the_values_of_their_formula(name: str, energy: float, twice_u: float) -> None:
    assert PAPER_FITS[name].escaped(energy) == pytest.approx(1.0 / (1.0 + np.exp(-twice_u)), rel=1e-12)


@pytest.mark.parametrize(
    ("name", "energy", "share"),
    [
        ("I", 0.5, 0.9025),
        ("I", 0.2, 0.51928),
        ("II", 0.5, 0.8475),
        ("II", 0.2, 0.41376),
        ("III", 0.6, 0.91732),
        ("III", 0.3, 0.24508),
    ],
)
def test_fits_of_direct_escapes_have_the_values_of_their_polynomials(name: str, energy: float, share: float) -> None:
    assert PAPER_FITS[name].direct(energy) == pytest.approx(share, rel=1e-12)
