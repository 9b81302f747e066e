"""Hover text of a pixel, the same on all pictures: what its colours say, in words."""

from __future__ import annotations

from bokeh.models import ColumnDataSource, CustomJSHover, HoverTool, Range1d

from engine import Certificate, Fate, Regularity, Trust
from engine.service import describe_certificate
from plots.palette import CROSSING_CLASSES, MOST_CHANNELS, OUTCOMES, PAPER

TRUST = {
    Trust.LIKE_NEIGHBOURS: "not tested: like all its neighbours",
    Trust.CONFIRMED: "confirmed: unchanged when computed again",
    Trust.DOUBTFUL: "doubtful: depends on rounding",
    Trust.NOT_TESTED: "trust: not tested yet",
}
"""What is known of a pixel while the layer "Pixels to trust" is on."""

CHARACTER = {
    Regularity.REGULAR: "regular",
    Regularity.CHAOTIC: "chaotic",
    Regularity.NOT_JUDGED: "regular or chaotic: not known yet",
}
"""What is known of a bounded orbit while the layer "Regular or chaotic" is on."""

# Columns of layers that are off, and of maps that they are not computed for, have other sizes.
_DETAILS = """
const {flat_index} = special_vars.image_index
const fates = source.data.fate[0]
const known = image => image?.length === fates.length ? image[flat_index] : undefined
const fate = fates[flat_index]
if (fate < bounded) return ""
const lines = []
const time = source.data.escape_time[0][flat_index]
const crossings = source.data.crossings[0][flat_index]
if (Number.isFinite(time)) lines.push(`escape time ${time.toPrecision(5)}`)
if (fate > bounded) lines.push(`${crossings} upward ${crossings == 1 ? "crossing" : "crossings"} of y = 0`)
else lines.push(certificates[source.data.crossing_class[0][flat_index] - first_certificate])
lines.push(characters[known(source.data.character[0]) - first])
const passage = known(source.data.passage[0]) - first
if (passage >= 0) {
  const origin = Math.floor(passage / ends)
  lines.push(origin > 0 ? `entered through channel ${origin}` : "never entered: inside since −t_max")
}
lines.push(trusts[known(doubts.data.trust[0])])
return lines.filter(line => line).join("\\n")
"""

# Enough decimals to distinguish neighbouring pixels.
_PLACE = """
const decimals = Math.min(Math.max(Math.ceil(3 - Math.log10(range.end - range.start)), 2), 17)
return value.toFixed(decimals)
"""

_TEXT = (
    '<div style="font-size:11px;line-height:14px;color:#1b1b1b"><b>@fate{custom}</b>'
    '<div style="white-space:pre-line">@crossing_class{custom}</div>($x{custom}, $y{custom})</div>'
)


def pixel_hover(source: ColumnDataSource, doubts: ColumnDataSource, x: Range1d, ordinate: Range1d) -> HoverTool:
    """A tool that describes the orbit under the mouse; the caller adds to its renderers.

    One formatter reads all columns, as Bokeh does not call formatters for NaN, the escape time of bounded orbits.

    Parameters
    ----------
    source
        Columns of `plots.image_columns.map_columns`.
    doubts
        Column ``trust`` of `Trust` codes; empty while that layer is off.
    x, ordinate
        Ranges of the pictures.
    """
    names = [*OUTCOMES.values(), *(f"escapes through channel {k + 1}" for k in range(len(PAPER.channels)))]
    arguments = {
        "source": source,
        "doubts": doubts,
        "bounded": list(OUTCOMES).index(Fate.BOUNDED),
        "certificates": [describe_certificate(code) for code in Certificate],
        "characters": [CHARACTER.get(code, "") for code in Regularity],
        "trusts": [TRUST.get(code, "") for code in Trust],
        "first": len(OUTCOMES),
        "first_certificate": len(OUTCOMES) + len(CROSSING_CLASSES),
        "ends": MOST_CHANNELS + 1,
    }
    formatters = {
        "@fate": CustomJSHover(args={"names": names}, code="return names[value] ?? names[0]"),
        "@crossing_class": CustomJSHover(args=arguments, code=_DETAILS),
        "$x": CustomJSHover(args={"range": x}, code=_PLACE),
        "$y": CustomJSHover(args={"range": ordinate}, code=_PLACE),
    }
    return HoverTool(tooltips=_TEXT, formatters=formatters, attachment="vertical", renderers=[])
