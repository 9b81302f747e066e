"""Pictures are side by side, or one picture is large above the others."""

from __future__ import annotations

from typing import Any

import pytest

from app.state.view import PICTURES, View
from app.state.view_state import ViewState
from app.views.components.plots import FigurePane
from app.views.maps.map_plots import PLAIN_PICTURES
from app.views.maps.picture_grid import SHORT_TITLES, PictureGrid
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
    assert not {"enlarged", "many"} & set(maps.grid.layout().css_classes)


def test_one_picture_is_enlarged_and_the_others_have_no_axes() -> None:
    pictures = grid(focus="times")
    assert named(pictures, "picked") == ["times"]
    assert named(pictures, "small") == [name for name in ALWAYS if name != "times"]
    assert "enlarged" in pictures.layout().css_classes
    for pane in panes(pictures):
        assert pane.object.below[0].visible == pane.object.left[0].visible == (pane.object.name == "times")


def test_one_of_many_pictures_is_twice_as_large_and_the_rest_have_no_axes() -> None:
    pictures = grid(*LAYERS_BY_PICTURE)
    assert "many" in pictures.layout().css_classes
    last = [*LAYERS_BY_PICTURE][-1]
    assert named(pictures, "picked") == [last]
    assert len(named(pictures, "compact")) == len(ALWAYS) + len(LAYERS_BY_PICTURE) - 1
    assert not any(pane.object.left[0].visible for pane in panes(pictures) if pane.object.name != last)


@pytest.mark.parametrize(
    ("layers", "classes"), [(0, set()), (1, {"many", "gap"}), (2, {"many"}), (3, {"many", "crowded", "gap"})]
)
def test_the_size_of_the_largest_picture_and_the_empty_cell_follow_from_the_number_of_pictures(
    layers: int, classes: set[str]
) -> None:
    pictures = grid(*[*LAYERS_BY_PICTURE][:layers])
    assert {"many", "crowded", "gap"} & set(pictures.layout().css_classes) == classes


@pytest.mark.parametrize(("on_demand", "largest"), [((), "basins"), (("characters",), "characters"), (("origins",), "origins")])
def test_the_picture_of_an_active_layer_is_the_largest(on_demand: tuple[str, ...], largest: str) -> None:
    assert named(grid(*on_demand), "picked") == [largest]


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


def test_the_picture_of_a_layer_that_shows_nothing_is_not_the_largest() -> None:
    pictures = grid("characters")
    pictures.mark_empty("characters", empty=True)
    assert named(pictures, "picked") == ["basins"]
    pictures.mark_empty("characters", empty=False)
    assert named(pictures, "picked") == ["characters"]
