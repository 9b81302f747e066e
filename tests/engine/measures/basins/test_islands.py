"""Areas of islands are right, within an error that follows from the resolution."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_islands, compute_map
from engine.measures.basins.islands import Islands
from engine.measures.basins.starts import Starts


def measure(bounded: np.ndarray) -> Islands:
    rows, columns = bounded.shape
    fate = np.where(bounded, 0, 1)
    return compute_islands(
        Starts(fate, np.ones(fate.shape), np.zeros(fate.shape, int), axes=(np.arange(columns), np.arange(rows)))
    )


@pytest.mark.parametrize(("across", "up"), [(11.3, 6.2), (20.1, 20.1), (25.2, 9.7)])
def test_the_error_is_the_scatter_of_the_area_over_shifted_grids(across: float, up: float) -> None:
    random, found = np.random.default_rng(1), []
    y, x = np.mgrid[-30:31, -30:31]
    for dx, dy, angle in random.uniform(0.0, 1.0, (1000, 3)):
        c, s = np.cos(np.pi * angle), np.sin(np.pi * angle)
        along, other = c * (x - dx) + s * (y - dy), c * (y - dy) - s * (x - dx)
        found.append(measure((along / across) ** 2 + (other / up) ** 2 <= 1.0))
    areas, errors = np.array([(one.area, one.area_error) for one in found]).T
    # More than 6 standard errors of the mean of 1000 areas.
    assert areas.mean() == pytest.approx(np.pi * across * up, rel=2e-3)
    # 5.5 standard errors of 2.2 % each, plus up to 16 % for circles, which the formula neglects.
    assert np.sqrt(np.mean((areas - np.pi * across * up) ** 2)) == pytest.approx(errors.mean(), rel=0.28)


def test_parts_that_share_a_corner_are_one_island_and_small_ones_do_not_count() -> None:
    image = np.zeros((9, 9), bool)
    image[1:3, 1:3] = image[3:5, 3:5] = image[7, 7] = True
    islands = measure(image)
    assert (islands.count, islands.area, islands.largest) == (1, 9.0, 8.0)


def test_without_bounded_starts_there_is_no_area() -> None:
    islands = measure(np.zeros((5, 5), bool))
    assert (islands.area, islands.area_error, islands.count, islands.largest) == (0.0, 0.0, 0, 0.0)
    assert islands.describe() == "No start is bounded."


def test_areas_are_in_units_of_the_axes_for_maps_and_their_datasets() -> None:
    # Below the escape energy all starts are bounded, in a disc of radius √(2h) at small energies.
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.02, (100, 80), t_max=100.0))
    of_map, of_dataset = compute_islands(frame), compute_islands(frame.to_xarray())
    assert of_map.area == pytest.approx(np.pi * 0.04, rel=0.02)
    assert of_dataset.area == pytest.approx(of_map.area, rel=1e-9)


def test_the_dataset_of_a_single_column_of_pixels_has_the_area_of_its_map() -> None:
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.02, (1, 20), t_max=100.0))
    assert 0.0 < compute_islands(frame.to_xarray()).area == pytest.approx(compute_islands(frame).area, rel=1e-9)
