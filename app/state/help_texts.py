"""Help texts of pictures and of plots of orbits: what each shows, and how to read it. Charts have theirs in their frames."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from types import MappingProxyType

from plots.layers.table import PICTURES
from plots.texts.typeset import typeset

HELP_TEXTS: Mapping[str, str] = MappingProxyType(
    {
        **{picture.name: picture.help for picture in PICTURES.values() if picture.help},
        "well": (
            "The zero-velocity curve V = h bounds the places that an orbit of this energy can reach. Above the escape energy, it "
            "has a gap at each saddle of the potential. An unstable periodic orbit, the Lyapunov orbit, spans each gap and marks "
            "the exit. An orbit has escaped when it crosses it outward. In the cases of the paper it never returns. Orbits also "
            "end at bodies, marked by dots, and at an escape radius; beside bodies, crosses mark the equilibria. The orbit under "
            "the cursor and the chosen orbits are drawn up to their ends, very long ones as density images. A regular orbit "
            "fills a regular pattern, a chaotic one does not."
        ),
        "sali": (
            "SALI, the smaller alignment index, follows two small deviations from the orbit. Chaos aligns them, and SALI "
            "decreases exponentially to the rounding error, about 10⁻¹⁶. On a regular orbit it stays large or decreases like "
            "a power of time, a straight line on these axes. A bounded orbit counts as chaotic if SALI is 10⁻⁷ or less."
        ),
        "exponent": (
            "The mean exponential growth rate of a small deviation until t. On a regular orbit it decreases like ln t / t, a "
            "falling curve on these axes. On a chaotic orbit it converges to the maximal Lyapunov exponent. Its inverse is "
            "the time in which an error grows by a factor of e."
        ),
        "r2": (
            "The squared distance from the origin. On a regular orbit it oscillates between fixed limits. A "
            "sticky orbit looks like that for a long time, until its range widens and it escapes. Drag over this curve, SALI "
            "or the Lyapunov exponent to see an interval of time in full detail; a double click shows the whole orbit again."
        ),
        "separation": (
            "The distance of two orbits in position and momentum, on a logarithmic scale. In a chaotic region neighbours "
            "separate exponentially, a rising straight line here, until their distance reaches the size of the well. Regular "
            "neighbours separate about in proportion to time, a curve that flattens."
        ),
        "watch": (
            "Orbits move in the well, each in the colour of the exit that it will take. Grey orbits stay until t = 100. A map "
            "of starts on the surface of section shows each orbit at its last passage. The solid curve of the chart is the share "
            "still inside. The dashed curve is the law of mixed motion: flux through the exits over the volume inside. Orbits "
            "that stick to islands stay longer."
        ),
    }
)
"""Help texts by the names of the pictures and plots."""


def title_with_help(title: str, name: str, text: str, under_way: str = "") -> str:
    """Return HTML with the title of `name`, a button that opens its help text, and a note on what is being computed."""
    button = f"<button type='button' class='help' popovertarget='help-{name}' aria-label='About: {escape(title)}'>?</button>"
    note = f" <small role='status'>{escape(under_way)}</small>" if under_way else ""
    return f"<h2>{escape(title)} {button}{note}</h2><p id='help-{name}' class='help-text' popover>{typeset(escape(text))}</p>"
