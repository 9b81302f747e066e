"""Colours with different meanings are distinguishable, also with a colour-vision deficiency."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from app.views.components.legends import passage_legend
from engine import CASES
from engine.potentials.outcomes import Centre, outcomes_of
from plots.palette import (
    CROSSING_CLASSES,
    DARK,
    DOUBT,
    LIGHT,
    MOST_CHANNELS,
    MOST_COLLISIONS,
    MOST_ORBITS,
    PALETTES,
    Palette,
    end_places,
)
from tests.disc import DISC, LABELS
from tests.plots.colour_vision import VISIONS, contrast, differences, lab

# Differences CIEDE2000: 2 is just visible, 10 is clear at a glance.
CLEAR = 10.0
PAGES = {"light": "#f5f6f8", "dark": "#13161a"}
of_each_palette = pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
for_each_vision = pytest.mark.parametrize("vision", VISIONS)


def closest(colours: list[str] | tuple[str, ...], vision: str = "normal") -> float:
    """The least difference of two of the colours."""
    apart = differences(colours, colours, vision)
    return float(apart[np.triu_indices(len(colours), 1)].min())


@of_each_palette
def test_there_is_a_colour_for_every_channel_class_and_orbit(palette: Palette) -> None:
    assert len(palette.channels) == MOST_CHANNELS
    assert len(palette.collisions) == MOST_COLLISIONS
    assert len(palette.classes) == len(CROSSING_CLASSES)
    assert len(palette.orbits) == MOST_ORBITS


@of_each_palette
def test_channels_crossing_classes_characters_and_orbits_have_no_colour_in_common(palette: Palette) -> None:
    kinds = (
        palette.channels,
        (*palette.collisions, palette.escape),
        palette.classes,
        palette.characters[1:],
        palette.orbits,
        (palette.bounded,),
    )
    for ones, others in itertools.combinations(kinds, 2):
        assert differences(ones, others).min() > CLEAR


@of_each_palette
def test_crossing_classes_and_channels_differ_from_escape_times(palette: Palette) -> None:
    assert differences(palette.classes, palette.escape_time).min() > CLEAR


@of_each_palette
def test_crossing_classes_are_ordered_from_light_to_dark(palette: Palette) -> None:
    lightness = lab(palette.classes)[:, 0]
    assert np.all(np.diff(lightness) < -10.0)


@of_each_palette
@for_each_vision
def test_crossing_classes_differ_from_each_other_and_from_bounded(palette: Palette, vision: str) -> None:
    assert closest([*palette.classes, palette.bounded], vision) > CLEAR


@of_each_palette
@for_each_vision
def test_regular_and_chaotic_orbits_differ_from_each_other_and_from_the_rest(palette: Palette, vision: str) -> None:
    assert closest([*palette.characters, palette.bounded], vision) > CLEAR


@for_each_vision
def test_channels_of_the_safe_palette_are_distinguishable(vision: str) -> None:
    safe = PALETTES["safe"]
    assert closest([*safe.channels[:4], safe.bounded], vision) > CLEAR


@of_each_palette
@for_each_vision
def test_collisions_and_escape_differ_from_each_other_and_from_exits_and_bounded_orbits(palette: Palette, vision: str) -> None:
    others = (*palette.collisions, palette.escape)
    assert closest(others, vision) > CLEAR
    assert differences(others, [*palette.channels, palette.bounded], vision).min() > CLEAR


@of_each_palette
@pytest.mark.parametrize("page", PAGES)
def test_collisions_and_escape_are_visible_on_the_page(palette: Palette, page: str) -> None:
    assert min(contrast(colour, PAGES[page]) for colour in (*palette.collisions, palette.escape)) > 1.5


@of_each_palette
def test_each_outcome_has_its_label_and_the_colour_of_its_kind(palette: Palette) -> None:
    entries = palette.end_entries(DISC.outcomes)
    assert [entry.label for entry in entries] == LABELS
    assert [entry.colour for entry in entries] == [*palette.channels[:2], palette.collisions[0]]


def test_an_outcome_has_the_same_place_whatever_the_number_of_exits() -> None:
    systems = [outcomes_of(exits, (Centre(0.0, 0.0, 0.1),), has_escape_radius=True) for exits in (0, 2, 8)]
    assert [end_places(outcomes)[-2:] for outcomes in systems] == [[8, 12]] * 3


@of_each_palette
@for_each_vision
def test_orbits_are_distinguishable(palette: Palette, vision: str) -> None:
    assert closest(palette.orbits, vision) > CLEAR


@of_each_palette
@pytest.mark.parametrize("page", PAGES)
def test_orbits_are_visible_on_the_page(palette: Palette, page: str) -> None:
    assert min(contrast(colour, PAGES[page]) for colour in palette.orbits) > 2.0


@of_each_palette
def test_one_of_the_tones_of_doubtful_pixels_is_visible_on_any_colour(palette: Palette) -> None:
    for colour in (*palette.channels, *palette.classes, palette.bounded):
        assert max(contrast(tone, colour) for tone in DOUBT) > 4.5


@of_each_palette
@pytest.mark.parametrize(("inks", "page"), [(LIGHT, "light"), (DARK, "dark")], ids=PAGES)
def test_the_curve_of_the_escape_energy_is_visible_and_no_channel(palette: Palette, inks, page: str) -> None:
    assert contrast(inks.critical_equipotential, PAGES[page]) > 4.5
    assert differences([inks.critical_equipotential], palette.channels).min() > CLEAR


@of_each_palette
def test_the_passages_of_four_channels_are_distinguishable(palette: Palette) -> None:
    assert closest([palette.passage_colour(origin, fate) for origin in range(5) for fate in range(1, 5)]) > 5.0


@of_each_palette
def test_an_orbit_that_is_bounded_in_both_directions_has_the_colour_of_bounded_orbits(palette: Palette) -> None:
    assert palette.passage_colour(0, 0) == palette.bounded


@of_each_palette
def test_the_legend_of_passages_has_a_patch_for_each_pair(palette: Palette) -> None:
    html = passage_legend(palette, CASES["II"].outcomes)
    for origin, fate in itertools.product(range(4), repeat=2):
        assert palette.passage_colour(origin, fate) in html
    assert html.count("--colour:") == 16
