"""The view state converts choices to requests."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from app.state.view_state import ViewState
from engine import (
    CASES,
    Coordinate,
    ParameterAxis,
    Plane,
    Slice,
    System,
    Window,
    integrate_orbit,
    read_section,
)
from engine.systems.catalogue.table import PAPER_ENERGIES
from plots.links.map_view import default_settings
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.palette import MOST_ORBITS


@pytest.mark.parametrize("case", list(CASES))
def test_the_energy_plane_spans_from_the_escape_energy_to_the_end_of_the_slider(case: str) -> None:
    spec = ViewState(system=System(case), plane=Plane.X_H).map_spec()
    assert spec.energy == (CASES[case].escape_energy, PAPER_ENERGIES[case].high)


def test_on_the_energy_plane_the_ordinate_is_the_energy() -> None:
    job = ViewState(system=System("II"), plane=Plane.X_H).orbit_job((0.1, 0.3))
    assert job is not None
    assert CASES["II"].energy(np.array(job.arguments[1])) == pytest.approx(0.3, abs=1e-15)


def test_a_forbidden_start_has_no_orbit() -> None:
    assert ViewState(system=System("I"), plane=Plane.X_PX, energy=0.2).orbit_job((0.0, 2.0)) is None


def starts_of(count: int) -> list[tuple[float, float]]:
    return [(0.01 * k, 0.0) for k in range(count)]


def test_a_new_start_is_chosen_unless_there_are_too_many() -> None:
    view = ViewState()
    assert view.chosen_start is None
    added = [view.add_start(start) for start in starts_of(MOST_ORBITS + 1)]
    assert view.chosen_start == starts_of(MOST_ORBITS)[-1]
    assert added == [True] * MOST_ORBITS + [False]
    assert view.starts == tuple(starts_of(MOST_ORBITS))


def test_an_existing_start_is_chosen() -> None:
    view = ViewState(starts=tuple(starts_of(3)), chosen=2)
    view.add_start(starts_of(3)[0])
    assert view.starts == tuple(starts_of(3))
    assert view.chosen == 0


def test_orbits_stay_on_another_slice_at_their_start_or_where_they_meet_the_section() -> None:
    view = ViewState(system=System("II"), plane=Plane.X_Y, energy=0.2, starts=((0.1, 0.2), (0.0, 5.0), (0.3, 0.0)), chosen=2)
    state = view.start_state((0.1, 0.2))
    assert state is not None
    orbit = integrate_orbit(CASES["II"], state, 100.0)
    view.known_orbits = {(0.1, 0.2): compute_orbit_curves(CASES["II"], orbit)}
    view.show_slice(Plane.X_PX)
    assert view.starts[1] == (0.3, 0.0) == view.chosen_start
    states, _ = orbit.find_section_states()
    assert view.start_state(view.starts[0]) == pytest.approx(states[0], abs=1e-12)


@pytest.mark.parametrize("changed", ["energy", "section", "system"])
def test_the_crossing_of_an_orbit_of_another_view_is_no_place(changed: str) -> None:
    view = ViewState(system=System("II"), plane=Plane.X_Y, energy=0.2, starts=((0.1, 0.2),))
    state = view.start_state((0.1, 0.2))
    assert state is not None
    view.known_orbits = {(0.1, 0.2): compute_orbit_curves(CASES["II"], integrate_orbit(CASES["II"], state, 100.0))}
    view.param.update(**{changed: {"energy": 0.21, "section": read_section("y = 0 both"), "system": System("HH")}[changed]})
    view.show_slice(Plane.X_PX)
    assert view.starts == ()


def test_an_orbit_without_a_place_on_another_slice_is_left_out() -> None:
    view = ViewState(system=System("II"), plane=Plane.X_PX, energy=0.2, starts=((0.1, 0.2), (0.1, 0.0)), chosen=0)
    view.show_slice(Plane.X_Y)
    assert (view.starts, view.chosen) == (((0.1, 0.0),), 0)
    view.show_slice(Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("II"))))
    assert view.starts == ()


@pytest.mark.parametrize(("place", "chosen"), [(0, 1), (2, 1)])
def test_after_a_removal_another_start_is_chosen(place: int, chosen: int) -> None:
    view = ViewState(starts=tuple(starts_of(3)), chosen=2)
    view.remove_start(place)
    assert len(view.starts) == 2
    assert view.chosen == chosen


@pytest.mark.parametrize("case", list(CASES))
def test_the_slider_contains_the_escape_energy_and_all_energies_of_the_paper(case: str) -> None:
    energies = PAPER_ENERGIES[case]
    assert energies.low < CASES[case].escape_energy < min(energies.marked)
    assert len(energies.marked) == 9
    assert max(energies.marked) <= energies.high
    assert energies.low < energies.first < energies.high


def test_the_end_of_a_comparison_changes_nothing_else() -> None:
    view, changed = ViewState(system=System("I"), energy=0.2), []
    view.compare(on=True)
    view.param.watch(lambda *events: changed.extend(event.name for event in events), [*view.param])
    view.compare(on=False)
    assert changed == ["compared"]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"layers": frozenset({"trust", "spirals"})}, "layers: spirals: must be among judge, trust"),
        ({"settings": {}}, "must have a value for each of images, "),
        ({"settings": {**default_settings(), "images": 4}}, r"settings: images=4: must be one of \[1, 2, 3, 0\]"),
    ],
)
def test_unknown_layers_and_illegal_settings_are_refused(values: dict[str, Any], message: str) -> None:
    view = ViewState(layers=frozenset({"trust"}))
    with pytest.raises(ValueError, match=message):
        view.param.update(values)
    assert view.layers == {"trust"}
    assert view.settings == default_settings()


def test_an_equal_slice_is_no_change() -> None:
    state, changed = ViewState(plane=Plane.X_PX), list[str]()
    state.param.watch(lambda *events: changed.extend(event.name for event in events), ["plane", "system", "window"])
    state.show(state.reviewed, plane=deepcopy(Plane.X_PX), window=Window(-0.1, 0.1, -0.2, 0.2))
    assert changed == ["window"]


def test_a_study_has_the_window_of_a_map_with_the_axes_of_the_section() -> None:
    window = Window(-0.1, 0.1, -0.2, 0.2)
    assert ViewState(plane=Plane.X_PX, window=window).subject.window == window
    assert ViewState(plane=Plane.X_Y, window=window).subject.window is None
    for text in ("x = 0", "x - y = 0", "x + 0.3 px = 0"):
        section = read_section(text)
        subject = ViewState(plane=section.slice_of_starts, section=section, window=window).subject
        assert subject.window == (window if text == "x = 0" else None)


def test_a_study_has_the_state_of_the_chosen_start_on_a_slice_of_one_potential() -> None:
    state = ViewState(starts=((0.1, 0.2),), chosen=0)
    x, y, px, py = state.subject.state or ()
    assert (x, y, px) == (0.1, 0.0, 0.2)
    assert state.potential.energy(np.array([x, y, px, py])) == pytest.approx(state.energy)
    along = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 1.5, state.system), Coordinate.PY, 1)
    state.param.update(plane=along, starts=((0.1, 0.9),), chosen=0)
    assert state.subject.state is None
