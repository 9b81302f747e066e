"""Pictures are side by side, or one picture is large above the others."""

from __future__ import annotations

from typing import Any

import pytest

from app.state.view import PICTURES, Analysis, View
from app.state.view_state import ViewState
from app.state.watched_starts import WATCH_KEY, WatchedStarts
from app.views.components.plots import FigurePane, PictureTexts
from app.views.maps.map_plots import PLAIN_PICTURES
from app.views.maps.picture_grid import SHORT_TITLES, PictureGrid
from engine import Coordinate, ParameterAxis, Plane, Slice, System
from plots.layers.table import LAYERS_BY_PICTURE
from tests.app.map_actions import make_maps

ALWAYS = [*PLAIN_PICTURES]


def grid(*on_demand: str, **values: Any) -> PictureGrid:
    """Return the grid of a view with the layers of these pictures."""
    return make_maps(ViewState(layers=frozenset(LAYERS_BY_PICTURE[name].name for name in on_demand), **values)).grid


def panes(of: PictureGrid) -> list[FigurePane]:
    return [part for part in of.layout().objects if isinstance(part, FigurePane)]


def named(of: PictureGrid, css_class: str) -> list[str]:
    return [pane.object.name for pane in panes(of) if css_class in pane.object.css_classes]


def test_every_picture_has_a_short_title() -> None:
    assert tuple(SHORT_TITLES) == PICTURES


def test_two_views_stand_side_by_side_before_the_well_and_their_difference() -> None:
    maps = make_maps(ViewState(compared=View()))
    assert [pane.object.name for pane in panes(maps.grid)] == ["basins", "compared", "well", "differences"]
    assert "two" in maps.grid.layout().css_classes


def test_one_picture_is_enlarged_and_the_others_have_no_axes() -> None:
    pictures = grid(focus="times")
    assert named(pictures, "picked") == ["times"]
    assert named(pictures, "small") == [name for name in ALWAYS if name != "times"]
    assert "enlarged" in pictures.layout().css_classes
    for pane in panes(pictures):
        assert pane.object.below[0].visible == pane.object.left[0].visible == (pane.object.name == "times")


@pytest.mark.parametrize(
    ("layers", "arrangement", "kind", "has_axes"),
    [(0, "two", "half", True), (1, "three", "third", True), (2, "four", "compact", False), (3, "many", "compact", False)],
)
def test_two_pictures_keep_their_places_above_the_others_of_which_few_have_axes(
    layers: int, arrangement: str, kind: str, has_axes: bool
) -> None:
    pictures = grid(*[*LAYERS_BY_PICTURE][:layers])
    assert arrangement in pictures.layout().css_classes
    first, second, *others = panes(pictures)
    assert [pane.object.name for pane in (first, second)] == ["well", "basins"]
    assert all(pane.object.left[0].visible for pane in (first, second))
    assert all(pane.object.css_classes[1] == kind and pane.object.left[0].visible is has_axes for pane in others)


def test_the_only_picture_of_a_narrow_page_is_that_of_the_last_layer() -> None:
    state = ViewState(layers=frozenset({LAYERS_BY_PICTURE["characters"].name}))
    pictures = make_maps(state).grid
    assert named(pictures, "picked") == ["basins"]
    state.narrow = True
    assert named(pictures, "picked") == ["characters"]


def test_a_picture_that_is_not_on_the_page_is_enlarged_when_it_appears() -> None:
    state = ViewState(focus="origins")
    pictures = make_maps(state).grid
    assert "enlarged" not in pictures.layout().css_classes
    state.switch_layer("origins", on=True)
    assert named(pictures, "picked") == ["origins"]


def test_the_picker_of_a_narrow_page_offers_the_pictures_and_reports_the_choice() -> None:
    state = ViewState(layers=frozenset({"origins"}))
    pictures = make_maps(state).grid
    state.narrow = True
    assert pictures.layout().objects[0] is pictures.picker
    assert list(pictures.picker.options.values()) == [*ALWAYS, "origins"]
    assert pictures.picker.value == "origins"
    pictures.picker.value = "basins"
    assert state.focus == "basins"
    state.focus = "well"
    assert pictures.picker.value == "well"


def test_the_picture_of_a_layer_that_shows_nothing_is_not_picked() -> None:
    pictures = grid("characters", narrow=True)
    pictures.mark_empty("characters", empty=True)
    assert named(pictures, "picked") == ["basins"]
    pictures.mark_empty("characters", empty=False)
    assert named(pictures, "picked") == ["characters"]


def launchers(of: PictureGrid) -> list[str]:
    """Return the pictures with a button that plays many orbits."""
    for name in of.shown:
        of.write(name, PictureTexts(name, name, ("x", "y"), ""))
    return [pane.object.name for pane in panes(of) if f"data-key='{WATCH_KEY}'" in pane.object.elements[0].html]


def test_the_picked_picture_has_a_button_that_plays_orbits_until_their_player_is_shown() -> None:
    state = ViewState(watched=WatchedStarts(count=20000))
    pictures = make_maps(state).grid
    assert launchers(pictures) == ["basins"]
    [basins] = [pane.object for pane in panes(pictures) if pane.object.name == "basins"]
    assert "Watch 20\N{NARROW NO-BREAK SPACE}000 leave" in basins.elements[0].html
    state.analysis = Analysis.WATCH
    assert "Watch" not in basins.elements[0].html
    state.param.update(analysis=Analysis.ORBIT, focus="well")
    assert launchers(pictures) == ["well"]
    state.focus = "times"
    assert launchers(pictures) == []


@pytest.mark.parametrize("several", [Plane.X_H, Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("III")))])
def test_a_slice_of_several_energies_or_systems_has_no_button_that_plays_orbits(several: Slice) -> None:
    assert launchers(grid(system=System("III"), plane=several)) == []


def test_a_narrow_page_shows_the_well_while_orbits_leave_it_unless_another_picture_is_chosen() -> None:
    state = ViewState(narrow=True)
    pictures = make_maps(state).grid
    state.analysis = Analysis.WATCH
    assert named(pictures, "picked") == ["well"]
    state.focus = "basins"
    assert named(pictures, "picked") == ["basins"]
    state.param.update(focus="", analysis=Analysis.ORBIT)
    assert named(pictures, "picked") == ["basins"]
