"""Components of {V ≤ h} around the origin are shown to be bounded exactly where they are."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from engine import parse_formula
from engine.expressions.nodes import from_terms
from engine.systems.landscape.hill_component import Barrier, ComponentSearch, Extent

# Formulas with the energy at which the region around the origin becomes unbounded.
OPENING = [
    ("½x² + 200(1 − exp(−0.05y))²", 200.0),
    ("½x² + ½y²/(1 + y²)", 0.5),
    ("½(x² + y²) − x²y²", 0.25),
    ("½(x² + y²) − xy²", 0.125),
    ("−1/√(r² + 1)", 0.0),
]
# Formulas with walls all around.
CLOSED = ["x² + y² + 0.1x²y²", "½log(r² + 0.04)", "exp(6x + 7y) + exp(6x − 7y) + exp(−12x)", "(x − y)⁴ + x² + y²", "2x² + y⁴"]


def search_for(formula: str) -> ComponentSearch:
    form = parse_formula(formula).form
    return ComponentSearch(form.definition if not isinstance(form.definition, tuple) else from_terms(form.coefficients), 1.0)


@pytest.mark.parametrize(("formula", "energy"), OPENING)
def test_a_region_is_bounded_below_the_energy_at_which_it_opens(formula: str, energy: float) -> None:
    search = search_for(formula)
    below, above = energy - 0.02 * max(abs(energy), 1.0), energy + 0.02 * max(abs(energy), 1.0)
    assert search.examine(below) is Extent.BOUNDED
    assert search.examine(above) is Extent.UNBOUNDED
    assert [search.sample(below), search.sample(above)] == [Extent.BOUNDED, Extent.UNBOUNDED]


@pytest.mark.parametrize(
    "formula", ["½u² − 0.3106u⁴ + 0.0075y²; u = x − 0.3271y²", "½u² − 0.2020u⁴ + 0.0061y²; u = x − 0.0440y²"]
)
def test_samples_see_ridges_that_are_narrower_than_cells(formula: str) -> None:
    text, definition = formula.split("; u = ")
    potential = parse_formula(text.replace("u", f"({definition})"))
    search = potential.well.component_search
    below, above = (share * potential.in_well_units.escape_energy for share in (0.999, 1.01))
    assert [search.sample(below), search.sample(above)] == [Extent.BOUNDED, Extent.UNBOUNDED]


def test_a_region_around_a_body_is_bounded_below_the_energy_at_which_it_opens() -> None:
    search = search_for("−1/r")
    assert search.examine(-0.02) is Extent.BOUNDED
    # Bounds of V at the body are infinite on both sides.
    assert search.examine(0.02) is Extent.UNDECIDED


@pytest.mark.parametrize("formula", CLOSED)
def test_a_region_between_walls_is_bounded(formula: str) -> None:
    search = search_for(formula)
    assert [search.examine(search_energy) for search_energy in (3.5, 7.0)] == [Extent.BOUNDED] * 2


def test_an_infinite_wall_bounds_a_region() -> None:
    # With the origin at (0.2, 0). The wall is at x = −0.2.
    form = parse_formula("½log((x + 0.2)² + y²) + 0.02/(x + 0.2)²").form
    assert ComponentSearch(form.definition, 1.0).examine(1.0) is Extent.BOUNDED


def test_the_answer_does_not_depend_on_the_spelling() -> None:
    pairs = [
        ("x² + y² + (x − y)⁴", "x² + y² + x⁴ − 4x³y + 6x²y² − 4xy³ + y⁴"),
        ("(1 − exp(−y))² + x²", "x² + 1 − 2exp(−y) + exp(−2y)"),
        ("(1 − exp(−y))² + x²", "(x² exp(2y) + (exp(y) − 1)²) exp(−2y)"),
    ]
    for one, other in pairs:
        for energy in (0.5, 0.9, 1.1, 2.0):
            assert search_for(one).examine(energy) is search_for(other).examine(energy)


@pytest.fixture
def gaps() -> list[Callable[[float], Barrier]]:
    """Return barriers of any half length across the gaps of case I at y = ±√½, through which it leads to infinity above 1/8."""
    saddles = np.array([[0.5, np.sqrt(0.5)], [0.5, -np.sqrt(0.5)]])
    outward = np.array([[np.sqrt(1 / 3), np.sqrt(2 / 3)], [np.sqrt(1 / 3), -np.sqrt(2 / 3)]])
    return [partial(Barrier.parabola, saddle, direction, 0.0) for saddle, direction in zip(saddles, outward, strict=True)]


def test_a_barrier_across_an_opening_bounds_the_region(gaps: list[Callable[[float], Barrier]]) -> None:
    search = search_for("½(x² + y²) − xy²")
    upper, lower = gaps
    assert search.examine(0.14, [upper(0.5), lower(0.5)]) is Extent.BOUNDED
    assert search.examine(0.14, [upper(0.5)]) is Extent.UNBOUNDED
    assert search.examine(0.14, [upper(0.02), lower(0.5)]) is Extent.UNBOUNDED


def test_barriers_that_pass_the_same_cells_bound_the_region(gaps: list[Callable[[float], Barrier]]) -> None:
    # At high energies, both barriers pass large cells near the origin, on which V never exceeds h. V is 0.85 at one end of a
    # barrier of half length 1, and 0.97 at the end of one of half length 1.1.
    search = search_for("½(x² + y²) − xy²")
    assert search.examine(0.9, [gap(1.1) for gap in gaps]) is Extent.BOUNDED
    assert search.examine(0.9, [gap(1.0) for gap in gaps]) is Extent.UNBOUNDED


def test_barriers_on_both_sides_of_the_origin_do_not_hide_an_opening() -> None:
    # The region leads to infinity along y, between the barriers x = ±0.3.
    search = ComponentSearch(from_terms({(2, 0): 0.5}), 1.0)
    barriers = [Barrier.parabola(np.array([0.3 * k, 0.0]), np.array([k, 0.0]), 0.0, 3.0) for k in (1.0, -1.0)]
    assert search.examine(2.0, barriers) is Extent.UNBOUNDED


def test_a_region_without_points_is_bounded() -> None:
    assert search_for("x² + y² + 1").examine(0.5) is Extent.BOUNDED


def test_random_regions_agree_with_a_fine_grid() -> None:
    # The components of random polynomials are found again on a grid of points, with SciPy's labels.
    from scipy import ndimage

    chance = np.random.default_rng(5)
    side = np.linspace(-6.0, 6.0, 601)
    x, y = np.meshgrid(side, side)
    decided = 0
    for _ in range(30):
        terms = {(2, 0): 0.5, (0, 2): 0.5} | {(i, 3 - i): float(c) for i, c in enumerate(chance.normal(0.0, 0.3, 4))}
        energy = float(chance.uniform(0.02, 2.0))
        extent = ComponentSearch(from_terms(terms), 1.0).examine(energy)
        values = sum(c * x**i * y**j for (i, j), c in terms.items())
        labels, _ = ndimage.label(values <= energy)
        reached = labels == labels[300, 300]
        touches_edge = bool(reached[[0, -1]].any() or reached[:, [0, -1]].any())
        decided += extent is not Extent.UNDECIDED
        assert not (extent is Extent.BOUNDED and touches_edge)
        assert not (extent is Extent.UNBOUNDED and not touches_edge)
    assert decided >= 27
