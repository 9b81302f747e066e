"""Entries of the catalogue have the exits, energies and integrals of the literature."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

from engine.systems.catalogue.table import CATALOGUE
from engine.systems.known_potentials import POTENTIALS

X, Y = sympy.symbols("x y", real=True)
MEMBERS = range(3, 9)
each_entry = pytest.mark.parametrize("name", POTENTIALS)


@each_entry
def test_each_entry_is_complete(name: str) -> None:
    entry = CATALOGUE[name]
    assert entry.name == POTENTIALS[name].name == name
    assert entry.title
    assert entry.reference
    assert entry.description.endswith(".")


@pytest.mark.parametrize("n", MEMBERS)
def test_family_matches_its_polar_form(n: int) -> None:
    angle, radius = np.linspace(0.0, 6.0, 25), 1.3
    value = POTENTIALS[f"C{n}"].value(radius * np.cos(angle), radius * np.sin(angle))
    np.testing.assert_allclose(value, 0.5 * radius**2 - radius**n * np.cos(n * angle) / n, atol=1e-11)


@pytest.mark.parametrize("n", MEMBERS)
def test_family_saddles_form_a_regular_polygon(n: int) -> None:
    angle = 2.0 * np.pi * np.arange(n) / n
    np.testing.assert_allclose(POTENTIALS[f"C{n}"].saddles, np.column_stack([np.cos(angle), np.sin(angle)]), atol=1e-12)
    assert POTENTIALS[f"C{n}"].escape_energy == pytest.approx(0.5 - 1.0 / n, rel=1e-13)


@pytest.mark.parametrize(
    ("name", "channels", "escape_energy"),
    [("HH", 3, 1 / 6), ("Barbanis", 2, 1.1**4 / (8 * 0.11**2)), ("Separable", 2, 1 / 12), ("One exit", 1, 1 / 216)],
)
def test_channels_and_escape_energy_of_literature_entries(name: str, channels: int, escape_energy: float) -> None:
    # Barbanis: with V = ½(a² x² + b² y²) − ε x y² the saddles lie at x = b²/2ε and V there is a² b⁴/8ε².
    potential = POTENTIALS[name]
    assert potential.channels == channels
    assert potential.escape_energy == pytest.approx(escape_energy, rel=1e-13)


def second_integral(name: str) -> tuple[sympy.Expr, sympy.Expr]:
    """Return the Hamiltonian of an integrable entry and an integral independent of it."""
    px, py = sympy.symbols("px py")
    value = sum(sympy.nsimplify(c, rational=True) * X**i * Y**j for i, j, c in POTENTIALS[name].terms)
    energy = (px**2 + py**2) / 2 + value
    if name == "Separable":
        return energy, px * py + X * Y + X**2 * Y + Y**3 / 3
    # For ½(A x² + B y²) + x y² + 2 x³: the integral of the KdV case, here with A = B = 1.
    return energy, -4 * py * (X * py - Y * px) + 4 * X * Y**2 + 4 * X**2 * Y**2 + Y**4 + 3 * (py**2 + Y**2)


@pytest.mark.parametrize("name", ["Separable", "One exit"])
def test_integrable_entries_have_a_second_integral(name: str) -> None:
    px, py = sympy.symbols("px py")
    energy, second = second_integral(name)
    pairs = ((X, px), (Y, py))
    bracket = sum(sympy.diff(second, q) * sympy.diff(energy, p) - sympy.diff(second, p) * sympy.diff(energy, q) for q, p in pairs)
    assert sympy.expand(bracket) == 0
