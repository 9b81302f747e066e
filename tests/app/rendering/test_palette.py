"""Colours that must be distinguishable differ."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from PIL import ImageColor

from app.rendering.palette import CROSSING_CLASSES, MOST_CHANNELS, PALETTES, Palette
from app.views.components.legends import passage_legend


def apart(one: str, two: str) -> float:
    return float(np.linalg.norm(np.subtract(ImageColor.getrgb(one)[:3], ImageColor.getrgb(two)[:3])))


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_there_is_a_colour_for_every_channel_and_class(palette: Palette) -> None:
    assert len(palette.channels) == MOST_CHANNELS
    assert len(palette.classes) == len(CROSSING_CLASSES)


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_the_passages_of_four_channels_are_distinguishable(palette: Palette) -> None:
    colours = [palette.passage_colour(origin, fate) for origin in range(5) for fate in range(1, 5)]
    assert min(apart(*pair) for pair in itertools.combinations(colours, 2)) > 20.0


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_an_orbit_that_is_bounded_in_both_directions_has_the_colour_of_bounded_orbits(palette: Palette) -> None:
    assert palette.passage_colour(0, 0) == palette.bounded


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_the_legend_of_passages_has_a_patch_for_each_pair(palette: Palette) -> None:
    html = passage_legend(palette, 3)
    for origin, fate in itertools.product(range(4), repeat=2):
        assert palette.passage_colour(origin, fate) in html
    assert html.count("background:") == 16
