"""The text of a pixel describes every code of the layers."""

from __future__ import annotations

import pytest
from bokeh.models import ColumnDataSource, CustomJSHover, Range1d

from app.views.maps.hover import pixel_hover
from engine import Evidence
from plots.layers.layer import Pixels
from plots.layers.table import LAYERS
from plots.pictures.palette import PAPER

PIXELS = [layer.pixels for layer in LAYERS.values() if layer.pixels is not None]


def test_every_column_of_a_layer_has_its_words() -> None:
    hover = pixel_hover(ColumnDataSource(), ColumnDataSource(), Range1d(), Range1d())
    formatter = hover.formatters["@crossing_class"]
    assert isinstance(formatter, CustomJSHover)
    words = formatter.args["words"]
    assert words["layers"] == {pixels.column: list(pixels.sentences) for pixels in PIXELS if pixels.values is None}
    assert words["values"] == {pixels.value_column: pixels.value_name for pixels in PIXELS if pixels.values is not None}
    assert len(words["evidence"]) == len(Evidence)


@pytest.mark.parametrize("pixels", PIXELS, ids=lambda pixels: pixels.column)
def test_every_code_of_a_layer_has_a_colour_and_words(pixels: Pixels) -> None:
    assert pixels.own_sentences is not None or len(pixels.colours(PAPER)) == len(pixels.sentences)
