"""Hover text of a pixel, the same on all pictures."""

from __future__ import annotations

from bokeh.models import ColumnDataSource, CustomJSHover, HoverTool, Range1d

from app.rendering.palette import CROSSING_CLASSES, OUTCOMES, PAPER
from engine import Certificate, Fate, describe_certificate

_DETAILS = """
const {flat_index} = special_vars.image_index
const fate = source.data.fate[0][flat_index]
if (fate < bounded) return ""
const time = source.data.escape_time[0][flat_index]
const crossings = `crossings of y = 0: ${source.data.crossings[0][flat_index]}`
if (Number.isFinite(time)) return `escape time ${time.toPrecision(5)}, ${crossings}`
const reason = certificates[source.data.crossing_class[0][flat_index] - first]
return fate > bounded ? crossings : reason
"""

# Enough decimals to distinguish neighbouring pixels.
_PLACE = """
const decimals = Math.min(Math.max(Math.ceil(3 - Math.log10(range.end - range.start)), 2), 17)
return value.toFixed(decimals)
"""

_TEXT = (
    '<div style="font-size:11px;line-height:14px;color:#1b1b1b"><b>@fate{custom}</b><br>'
    "@crossing_class{custom}<br>($x{custom}, $y{custom})</div>"
)


def pixel_hover(source: ColumnDataSource, x: Range1d, ordinate: Range1d) -> HoverTool:
    """A tool that shows the fate of the orbit under the mouse; the caller adds to its renderers.

    One formatter reads all columns, as Bokeh does not call formatters for NaN, the escape time of bounded orbits.
    """
    names = [*OUTCOMES.values(), *(f"escapes through channel {k + 1}" for k in range(len(PAPER.channels)))]
    arguments = {
        "source": source,
        "bounded": list(OUTCOMES).index(Fate.BOUNDED),
        "certificates": [describe_certificate(code) for code in Certificate],
        "first": len(OUTCOMES) + len(CROSSING_CLASSES),
    }
    formatters = {
        "@fate": CustomJSHover(args={"names": names}, code="return names[value] ?? names[0]"),
        "@crossing_class": CustomJSHover(args=arguments, code=_DETAILS),
        "$x": CustomJSHover(args={"range": x}, code=_PLACE),
        "$y": CustomJSHover(args={"range": ordinate}, code=_PLACE),
    }
    return HoverTool(tooltips=_TEXT, formatters=formatters, attachment="vertical", renderers=[])
