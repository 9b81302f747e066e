"""The study of a plate shows the maps of its energies and values of a parameter, and opens the one that is clicked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import MapSpec, Plane, System, compute_map, compute_sweep
from engine.results import Sweep
from engine.systems.review.potential_review import review_system
from engine.systems.system import TYPED
from plots.pictures.image_columns import fate_codes
from plots.pictures.palette import PAPER
from plots.pictures.setting import NO_SETTINGS
from plots.studies.plate import PLATE, PLATE_GRID, PLATE_STUDY
from plots.studies.study import Click, Subject

SYSTEM = System("II", parameters={"epsilon": 0.9})
SUBJECT = Subject(SYSTEM, SYSTEM.potential, Plane.X_PX, 0.3, review_system(SYSTEM).energies, 100.0)


@pytest.fixture(scope="module")
def found() -> Sweep:
    (spec,) = PLATE_STUDY.job(SUBJECT, "omega_1").arguments
    return compute_sweep(replace(spec, resolution=(16, 16)))


def test_energies_increase_to_the_right_and_the_parameter_upward(found: Sweep) -> None:
    tiles = PLATE_STUDY.charts(found, PAPER, NO_SETTINGS)[0].tiles
    assert len(tiles) == PLATE_GRID.columns * PLATE_GRID.rows
    lefts, bottoms = (sorted({getattr(tile, edge) for tile in tiles}) for edge in ("left", "bottom"))
    for tile in tiles:
        k, row = lefts.index(tile.left), bottoms.index(tile.bottom)
        assert tile.name == f"h = {found.values[k]:g}, ω1 = {found['omega_1'][row]:g}"


def test_the_axes_name_the_values_beside_their_maps(found: Sweep) -> None:
    (chart,) = PLATE_STUDY.charts(found, PAPER, NO_SETTINGS)
    assert chart.frame.labels == ("h", "ω1")
    for tile in chart.tiles:
        h, omega = (ticks[edge + 0.5] for ticks, edge in zip(chart.ticks, (tile.left, tile.bottom), strict=True))
        values = [float(part.split(" = ")[1]) for part in tile.name.split(", ")]
        assert [float(h), float(omega)] == values
        # The text above a map is as narrow as the map.
        assert "=" not in tile.text


def test_each_tile_is_the_map_of_its_energy_and_parameter(found: Sweep) -> None:
    tiles = PLATE_STUDY.charts(found, PAPER, NO_SETTINGS)[0].tiles
    window = found.dataset.attrs["window"]
    for k, row in ((0, 0), (2, 4), (4, 1)):
        potential = SYSTEM.with_parameter("omega_1", float(found["omega_1"][row])).potential
        alone = compute_map(MapSpec(potential, Plane.X_PX, float(found.values[k]), (16, 16), window, t_max=100.0))
        left, bottom = PLATE_GRID.corner((PLATE_GRID.rows - 1 - row) * PLATE_GRID.columns + k)
        (tile,) = (each for each in tiles if (each.left, each.bottom) == (left, bottom))
        np.testing.assert_array_equal(tile.codes, fate_codes(alone.fate, potential.outcomes))


@pytest.mark.parametrize(("k", "row"), [(0, 0), (4, 0), (1, 3)])
def test_a_click_opens_the_map_under_it(found: Sweep, k: int, row: int) -> None:
    left, bottom = PLATE_GRID.corner((PLATE_GRID.rows - 1 - row) * PLATE_GRID.columns + k)
    click = Click(PLATE.name, left + 0.5, bottom + 0.5)
    changes = PLATE_STUDY.changes(SUBJECT, "omega_1", found, click)
    assert changes["energy"] == found.values[k]
    assert changes["system"] == SYSTEM.with_parameter("omega_1", float(found["omega_1"][row]))
    assert PLATE_STUDY.changes(SUBJECT, "omega_1", found, click._replace(y=bottom - 0.1)) == {}


def test_tiles_keep_their_places_while_others_are_missing(found: Sweep) -> None:
    whole = {tile.name: (tile.left, tile.bottom) for tile in PLATE_STUDY.charts(found, PAPER, NO_SETTINGS)[0].tiles}
    part = replace(found, dataset=found.dataset.isel(h=[1, 4]))
    tiles = PLATE_STUDY.charts(part, PAPER, NO_SETTINGS)[0].tiles
    assert len(tiles) == 2 * PLATE_GRID.rows
    assert all(whole[tile.name] == (tile.left, tile.bottom) for tile in tiles)
    assert not PLATE_STUDY.is_complete(part)


def test_letters_of_a_formula_are_offered_first() -> None:
    assert PLATE_STUDY.axes(System(TYPED, "½(x² + y²) + a x²y − y³/3"))[0] == "a"


def test_a_system_without_parameters_has_no_plate() -> None:
    system = System("Hill")
    about = replace(SUBJECT, system=system, potential=system.potential)
    assert PLATE_STUDY.axes(system) == ()
    with pytest.raises(ValueError, match="This system has no parameter"):
        PLATE_STUDY.job(about, "")
