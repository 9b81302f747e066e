"""The relief of a well is lit from the upper left, and dark at its bottom."""

from __future__ import annotations

import numpy as np
import pytest

from app.views.maps.relief import shade_relief
from app.views.maps.well import well_spec
from engine import CASES, POTENTIALS


def shade_at(case: str, energy: float, x: float, y: float) -> int:
    potential = CASES.get(case) or POTENTIALS[case]
    shades, window = shade_relief(well_spec(potential, energy))
    rows, columns = shades.shape
    column = int((x - window.x_low) / window.width * (columns - 1) + 0.5)
    row = int((y - window.ordinate_low) / window.height * (rows - 1) + 0.5)
    return int(shades[row, column])


@pytest.mark.parametrize(("case", "energy"), [("III", 0.26), ("II", 0.16)])
def test_the_slope_towards_the_light_is_lighter_than_the_opposite_slope(case: str, energy: float) -> None:
    assert shade_at(case, energy, 0.3, -0.3) > shade_at(case, energy, -0.3, 0.3)


def test_the_bottom_is_darker_than_the_places_above_the_energy() -> None:
    # At x = 0, the plateau of case III begins at y = 0.81.
    assert shade_at("III", 0.26, 0.0, 0.0) < shade_at("III", 0.26, 0.0, 1.0)


def test_the_slope_fades_above_the_energy() -> None:
    # Along this line, V of case I rises from the bottom to 3.7 times the energy.
    shades = [shade_at("I", 0.05, -t, 0.5 * t) for t in np.linspace(0.0, 0.5, 120)]
    assert max(shades) - min(shades) > 15
    assert np.abs(np.diff(shades)).max() <= 6


def test_only_the_surroundings_of_bodies_are_deep() -> None:
    near, far = (shade_at("Copenhagen", -1.6, x, -0.05) for x in (-0.5, 2.0))
    assert near != far
    shades, window = shade_relief(well_spec(POTENTIALS["Copenhagen"], -1.6))
    assert np.unique(shades).size > 20
    shown = well_spec(POTENTIALS["Copenhagen"], -1.6).find_window()
    assert window.x_low < shown.x_low < shown.x_high < window.x_high
