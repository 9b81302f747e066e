"""Colours with different meanings are distinguishable, also with a colour-vision deficiency."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from engine import Regularity
from plots.layers.regularity import CODES, entries
from plots.layers.trust import TONES
from plots.pictures.palette import (
    DARK,
    DEFAULT_COLOURS,
    LIGHT,
    PALETTES,
    Palette,
)
from tests.plots.colour_vision import VISIONS, contrast, differences

# Differences CIEDE2000: 2 is just visible, 10 is clear at a glance.
CLEAR = 10.0
# Characters with colours of their own.
SHOWN = set(Regularity) - {Regularity.NOT_APPLICABLE, Regularity.NOT_JUDGED}
PAGES = {"light": "#f5f6f8", "dark": "#13161a"}
of_each_palette = pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
for_each_vision = pytest.mark.parametrize("vision", VISIONS)


def closest(colours: list[str] | tuple[str, ...], vision: str = "normal") -> float:
    """Return the least difference of two of the colours."""
    apart = differences(colours, colours, vision)
    return float(apart[np.triu_indices(len(colours), 1)].min())


@of_each_palette
def test_channels_crossing_classes_characters_and_orbits_have_no_colour_in_common(palette: Palette) -> None:
    kinds = (
        palette.channels,
        palette.ends[len(palette.channels) :],
        palette.classes,
        [entry.colour for code, entry in zip(CODES, entries(palette), strict=True) if code.code in SHOWN],
        palette.orbits,
        (palette.bounded,),
    )
    for ones, others in itertools.combinations(kinds, 2):
        assert differences(ones, others).min() > CLEAR


@of_each_palette
@for_each_vision
def test_colours_of_one_kind_differ_from_each_other(palette: Palette, vision: str) -> None:
    for kind in ([*palette.classes, palette.bounded], [entry.colour for entry in entries(palette)], palette.orbits):
        assert closest(kind, vision) > CLEAR


@for_each_vision
def test_exits_have_clear_colours_by_default(vision: str) -> None:
    assert closest([*DEFAULT_COLOURS.channels[:4], DEFAULT_COLOURS.bounded], vision) > CLEAR


@pytest.mark.parametrize("page", PAGES)
def test_exits_are_visible_on_the_page_by_default(page: str) -> None:
    assert min(contrast(colour, PAGES[page]) for colour in DEFAULT_COLOURS.channels[:4]) > 2.0


@of_each_palette
@for_each_vision
def test_collisions_and_escape_differ_from_each_other_and_from_exits_and_bounded_orbits(palette: Palette, vision: str) -> None:
    others = palette.ends[len(palette.channels) :]
    assert closest(others, vision) > CLEAR
    assert differences(others, [*palette.channels, palette.bounded], vision).min() > CLEAR


@of_each_palette
@pytest.mark.parametrize("page", PAGES)
def test_orbits_collisions_and_escape_are_visible_on_the_page(palette: Palette, page: str) -> None:
    assert min(contrast(colour, PAGES[page]) for colour in palette.orbits) > 2.0
    assert min(contrast(colour, PAGES[page]) for colour in palette.ends[len(palette.channels) :]) > 1.5


@of_each_palette
def test_one_of_the_tones_of_doubtful_pixels_is_visible_on_any_colour(palette: Palette) -> None:
    for colour in (*palette.channels, *palette.classes, palette.bounded):
        assert max(contrast(tone, colour) for tone in TONES) > 4.5


@of_each_palette
@pytest.mark.parametrize(("colours", "page"), [(LIGHT, "light"), (DARK, "dark")], ids=PAGES)
def test_the_curve_of_the_escape_energy_is_visible_and_no_channel(palette: Palette, colours, page: str) -> None:
    assert contrast(colours.critical_equipotential, PAGES[page]) > 4.5
    assert differences([colours.critical_equipotential], palette.channels).min() > CLEAR
