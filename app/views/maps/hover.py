"""Hover tools of pictures, which describe the orbit that starts at a pixel. The pictures of one map share a tool."""

from __future__ import annotations

from pathlib import Path

from bokeh.models import ColumnDataSource, CustomJSHover, HoverTool, Range1d

from app.views.components.plots import hover_html
from engine import Evidence, Fate
from engine.propagation.fates import describe_evidence
from plots.browser.javascript import callback_code
from plots.layers.table import LAYERS
from plots.pictures.image_columns import FIRST_CLASS
from plots.pictures.palette import CROSSING_CLASSES, OUTCOMES

_MODULE = Path(__file__).with_name("hover_texts.js")
_COLUMNS = "{maps: maps.data, compared: compared.data}"
_DETAILS_CODE = callback_code(_MODULE, f"pixelDetails(special_vars.image_index.flat_index, {_COLUMNS}, codes, words)")
_FATE_CODE = callback_code(_MODULE, "fateName(value, names, maps.data)")
_COORDINATE_CODE = callback_code(_MODULE, "coordinate(value, range)")

# The formatter reads all columns, so the column that it is written for only needs finite numbers.
_DETAILS_HTML = '<div style="white-space:pre-line">@crossing_class{custom}</div>'
_FATE_HTML, _START_HTML = "<b>@fate{custom}</b>", "<div>($x{custom}, $y{custom})</div>"

_FATE_NAMES = list(OUTCOMES.values())


def fate_hover(source: ColumnDataSource, x: Range1d, ordinate: Range1d) -> HoverTool:
    """Return a tool that shows outcome and start of the orbit under the mouse. The caller sets images of fates as renderers.

    Parameters
    ----------
    source
        Columns ``fate`` and ``ends`` of `plots.pictures.image_columns.map_columns`.
    x, ordinate
        Ranges of the pictures.
    """
    return _hover_tool("", _fate_and_start_formatters(source, x, ordinate))


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
    # Pixel codes: of bounded orbits in "fate", of the first class in "difference", of the first evidence in "crossing_class".
    codes = {
        "bounded": list(OUTCOMES).index(Fate.BOUNDED),
        "firstDifference": FIRST_CLASS,
        "firstEvidence": FIRST_CLASS + len(CROSSING_CLASSES),
    }
    layers = [layer.pixels for layer in LAYERS.values() if layer.pixels is not None]
    words = {
        "evidence": [describe_evidence(code) for code in Evidence],
        "layers": {pixels.column: list(pixels.sentences) for pixels in layers if pixels.values is None},
        "values": {pixels.value_column: pixels.value_name for pixels in layers if pixels.values is not None},
        "fates": _FATE_NAMES,
    }
    arguments = {"maps": source, "compared": compared, "codes": codes, "words": words}
    details = {"@crossing_class": CustomJSHover(args=arguments, code=_DETAILS_CODE)}
    return _hover_tool(_DETAILS_HTML, _fate_and_start_formatters(source, x, ordinate) | details)


def _fate_and_start_formatters(source: ColumnDataSource, x: Range1d, ordinate: Range1d) -> dict[str, CustomJSHover]:
    return {
        "@fate": CustomJSHover(args={"names": _FATE_NAMES, "maps": source}, code=_FATE_CODE),
        "$x": CustomJSHover(args={"range": x}, code=_COORDINATE_CODE),
        "$y": CustomJSHover(args={"range": ordinate}, code=_COORDINATE_CODE),
    }


def _hover_tool(details: str, formatters: dict[str, CustomJSHover]) -> HoverTool:
    """Return a tool without renderers. Its text has details (HTML) between the fate and the coordinates."""
    text = hover_html(_FATE_HTML + details + _START_HTML)
    return HoverTool(tooltips=text, formatters=formatters, attachment="vertical", show_arrow=False, renderers=[])
