"""The picture of the well follows the maps, and shows the chosen orbits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.views.maps.well import WellView, sketch_spec
from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    MapSpec,
    ParameterAxis,
    Plane,
    Slice,
    System,
    Window,
    integrate_orbit,
    start_states,
)
from plots.pictures.orbit_curves import OrbitCurves, compute_orbit_curves
from tests.app.map_actions import make_well


def curves_of(case: str, energy: float, x: float = 0.1) -> OrbitCurves:
    [start] = start_states(CASES[case], Plane.X_PX, energy, np.array([x]), np.array([0.0]))
    return compute_orbit_curves(CASES[case], integrate_orbit(CASES[case], start, 10.0))


def source(well: WellView, name: str) -> Any:
    return next(each.data_source for each in well.plot.renderers if each.data_source.name == name)


def edges(well: WellView) -> tuple[float, ...]:
    x, y = well.plot.x_range, well.plot.y_range
    return x.start, x.end, y.start, y.end


@pytest.mark.parametrize(("case", "energy", "exits"), [("I", 0.19, 2), ("III", 0.3, 4), ("I", 0.1, 0)])
@pytest.mark.parametrize("plane", [Plane.X_PX, Plane.X_Y])
def test_the_exits_of_the_map_are_drawn_on_every_plane(case: str, energy: float, exits: int, plane: Plane) -> None:
    well = make_well()
    well.show_map(MapSpec(CASES["III"], Plane.X_PX, 0.4))
    well.show_map(MapSpec(CASES[case], plane, energy))
    assert len(source(well, "lyapunov_orbits").data["xs"]) == exits


def test_a_zoom_of_the_maps_leaves_the_whole_well_in_view() -> None:
    well = make_well()
    well.show_map(MapSpec(CASES["III"], Plane.X_Y, 0.4))
    whole = edges(well)
    well.show_map(MapSpec(CASES["III"], Plane.X_Y, 0.4, window=Window(0.1, 0.2, 0.1, 0.2)))
    assert edges(well) == whole


def test_the_paths_end_and_begin_with_their_orbits() -> None:
    well, drawings = make_well(), [curves_of("III", 0.4, x) for x in (0.1, 0.2)]
    well.show_map(MapSpec(CASES["III"], Plane.X_PX, 0.4))
    well.show_orbits([drawings[0], None, drawings[1]], chosen=0)
    paths = source(well, "paths").data
    assert paths["slot"] == [2, 0]
    assert [line[-1] for line in paths["xs"]] == pytest.approx([drawings[1].orbit.x[-1], drawings[0].orbit.x[-1]])
    assert source(well, "points").data["x"] == pytest.approx([0.2, 0.1])


def test_a_sketch_has_neither_exits_nor_orbits_and_ends_with_a_map_of_its_potential() -> None:
    well, potential = make_well(), CASES["II"]
    well.show_map(MapSpec(CASES["III"], Plane.X_PX, 0.4))
    well.show_orbits([curves_of("III", 0.4)], 0)
    well.show_sketch(sketch_spec(potential, 0.2))
    assert len(source(well, "paths").data["xs"]) == len(source(well, "lyapunov_orbits").data["xs"]) == 0
    half = 1.5 * float(np.hypot(*potential.saddles[0]))
    assert edges(well) == pytest.approx((-half, half, -half, half))
    well.show_map(MapSpec(CASES["III"], Plane.X_PX, 0.45))
    assert edges(well) == pytest.approx((-half, half, -half, half))
    well.show_map(MapSpec(potential, Plane.X_PX, 0.2))
    assert len(source(well, "lyapunov_orbits").data["xs"]) == potential.channels


def test_a_long_path_that_is_not_chosen_does_not_cover_the_chosen_one() -> None:
    well = make_well()
    long = compute_orbit_curves(CASES["I"], integrate_orbit(CASES["I"], (-0.46, 0.0, 0.0, 0.2), 2000.0))
    assert long.visits is not None
    for chosen in (0, 1):
        well.show_orbits([long, curves_of("I", 0.19)], chosen)
        assert (source(well, "shades").data["alpha"][0] == 1.0) == (chosen == 0)
    order = [each.data_source.name for each in well.plot.renderers]
    assert order.index("shades") < order.index("paths")


def test_the_points_move_along_the_orbits() -> None:
    well, drawing = make_well(), curves_of("III", 0.4)
    well.show_map(MapSpec(CASES["III"], Plane.X_PX, 0.4))
    well.show_orbits([drawing], chosen=0)
    well.set_time(1.0)
    sample = np.searchsorted(drawing.orbit.t, 1.0, side="right") - 1
    assert source(well, "points").data["y"] == [drawing.orbit.y[sample]]
    well.set_time(None)
    assert source(well, "points").data["y"] == [drawing.orbit.y[0]]


def test_on_a_slice_along_h_the_well_has_the_energy_of_the_chosen_orbit() -> None:
    well, spec = make_well(), MapSpec(CASES["III"], Plane.X_H, (0.2, 0.6))
    well.show_map(spec)
    highest = edges(well)
    well.show_orbits([curves_of("III", 0.3), curves_of("III", 0.2)], chosen=0)
    assert len(source(well, "lyapunov_orbits").data["xs"]) == 4
    well.show_orbits([curves_of("III", 0.3), curves_of("III", 0.2)], chosen=1)
    assert not source(well, "lyapunov_orbits").data["xs"]
    well.show_orbits([], chosen=0)
    assert edges(well) == highest


def test_on_a_slice_along_a_parameter_the_well_is_that_of_the_chosen_orbit() -> None:
    well, along = make_well(), Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I")))
    stronger = CASES["I"].with_parameters(epsilon=1.5)
    drawings = [
        compute_orbit_curves(potential, integrate_orbit(potential, (0.1, 0.0, 0.0, 0.6), 10.0))
        for potential in (CASES["I"], stronger)
    ]
    well.show_map(MapSpec(CASES["I"], along, 0.2))
    well.show_orbits(drawings, chosen=1)
    own = make_well()
    own.show_map(MapSpec(stronger, Plane.X_PX, drawings[1].orbit.energy))
    assert edges(well) == edges(own)
    # The path of an orbit in another well is left out.
    assert source(well, "paths").data["slot"] == [1]


def test_bodies_and_equilibria_of_a_three_body_problem_are_marked() -> None:
    well, copenhagen = make_well(), POTENTIALS["Copenhagen"]
    well.show_map(MapSpec(copenhagen, Plane.X_Y, -1.6))
    marks = source(well, "marked_places").data
    places = sorted(zip(marks["marker"], np.round(marks["x"], 6), np.round(marks["y"], 6), strict=True))
    # Two bodies, the triangular and the collinear points (Szebehely 1967, Theory of Orbits, section 4.6).
    assert places[:2] == [("circle", -0.5, 0.0), ("circle", 0.5, 0.0)]
    lagrange = [(-1.198406, 0.0), (0.0, -0.866025), (0.0, 0.0), (0.0, 0.866025), (1.198406, 0.0)]
    assert [(x, y) for _, x, y in places[2:]] == lagrange
    well.show_map(MapSpec(CASES["III"], Plane.X_Y, 0.4))
    assert len(source(well, "marked_places").data["marker"]) == 0
