"""Hover text of a pixel. It says what the colours of the pixel mean, and is the same on all pictures."""

from __future__ import annotations

from bokeh.models import ColumnDataSource, CustomJSHover, HoverTool, Range1d

from app.browser.javascript import callback_code
from app.views.components.plots import HOVER_TEXTS, hover_html
from engine import Evidence, Fate
from engine.propagation.fates import describe_evidence
from plots.layers.table import LAYERS
from plots.pictures.palette import CROSSING_CLASSES, OUTCOMES

_COLUMNS = "{maps: maps.data, compared: compared.data}"
_DETAILS = callback_code(HOVER_TEXTS, f"pixelDetails(special_vars.image_index.flat_index, {_COLUMNS}, codes, words)")
_FATE = callback_code(HOVER_TEXTS, "fateName(value, names, maps.data)")
_PLACE = callback_code(HOVER_TEXTS, "coordinate(value, range)")

_DETAILS_TEXT = '<div style="white-space:pre-line">@crossing_class{custom}</div>'
_FATE_TEXT = "<b>@fate{custom}</b>"
_PLACE_TEXT = "<div>($x{custom}, $y{custom})</div>"

_FATES = list(OUTCOMES.values())


def fate_hover(source: ColumnDataSource, x: Range1d, ordinate: Range1d) -> HoverTool:
    """Return a tool that shows the outcome of the orbit under the mouse. The caller sets images of fate codes as renderers.

    Parameters
    ----------
    source
        Columns ``fate`` and ``ends`` of `plots.pictures.image_columns.map_columns`.
    x, ordinate
        Ranges of the pictures.
    """
    formatters = _fate_and_place(source, x, ordinate)
    text = hover_html(_FATE_TEXT + _PLACE_TEXT)
    return HoverTool(tooltips=text, formatters=formatters, attachment="vertical", show_arrow=False, renderers=[])


def _fate_and_place(source: ColumnDataSource, x: Range1d, ordinate: Range1d) -> dict[str, CustomJSHover]:
    return {
        "@fate": CustomJSHover(args={"names": _FATES, "maps": source}, code=_FATE),
        "$x": CustomJSHover(args={"range": x}, code=_PLACE),
        "$y": CustomJSHover(args={"range": ordinate}, code=_PLACE),
    }


def pixel_hover(source: ColumnDataSource, compared: ColumnDataSource, x: Range1d, ordinate: Range1d) -> HoverTool:
    """Return a tool that describes the orbit under the mouse. The caller sets images as renderers.

    A single formatter reads all columns: Bokeh calls no formatter for NaN, such as the escape time of a bounded orbit.

    Parameters
    ----------
    source
        Columns of `plots.pictures.image_columns.map_columns` and of the layers.
    compared
        Columns of the map of the other view.
    x, ordinate
        Ranges of the pictures.
    """
    # Codes of bounded orbits, of the first difference, and of the first kind of evidence, in their images.
    codes = {
        "bounded": list(OUTCOMES).index(Fate.BOUNDED),
        "first": len(OUTCOMES),
        "firstEvidence": len(OUTCOMES) + len(CROSSING_CLASSES),
    }
    layers = [layer.pixels for layer in LAYERS.values() if layer.pixels is not None]
    words = {
        "evidence": [describe_evidence(code) for code in Evidence],
        "layers": {pixels.column: list(pixels.sentences) for pixels in layers if pixels.values is None},
        "values": {pixels.value_column: pixels.value_name for pixels in layers if pixels.values is not None},
        "fates": _FATES,
    }
    arguments = {"maps": source, "compared": compared, "codes": codes, "words": words}
    formatters = _fate_and_place(source, x, ordinate) | {"@crossing_class": CustomJSHover(args=arguments, code=_DETAILS)}
    text = hover_html(_FATE_TEXT + _DETAILS_TEXT + _PLACE_TEXT)
    return HoverTool(tooltips=text, formatters=formatters, attachment="vertical", show_arrow=False, renderers=[])
