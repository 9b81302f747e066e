"""Help texts: what each picture and plot shows, and how to read it."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from types import MappingProxyType

from engine import MEASURES
from plots.layers.table import PICTURES

HELP_TEXTS: Mapping[str, str] = MappingProxyType(
    {
        **{picture.name: picture.help for picture in PICTURES.values() if picture.help},
        "well": (
            "The zero-velocity curve V = h bounds the places that an orbit of this energy can reach. Above the escape energy, it "
            "has a gap at each saddle of the potential. An unstable periodic orbit, the Lyapunov orbit, spans each gap and marks "
            "the exit. An orbit has escaped when it crosses it outward. In the cases of the paper it never returns. Orbits also "
            "end at bodies and at an escape radius. The orbit under the cursor and the chosen orbits are drawn up to their ends, "
            "very long ones as density images. A regular orbit fills a regular pattern, a chaotic one does not."
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
        "histogram": (
            "How many starts escape when. Each bin spans the same factor of time. The peak is the typical escape time. The "
            "tail on the right comes from fractal boundaries and from orbits that stick to islands. Bounded orbits are not "
            "included."
        ),
        "probabilities": (
            "Of the orbits that have not escaped at their n-th upward crossing of y = 0, the share that escapes before the "
            "next one; n = 0 is the share of direct escapes. If the motion inside the well were well mixed, the probability "
            "would be the same for all n. Bounded orbits stay in the count, so if there are any, it tends to zero."
        ),
        "uncertainty": (
            "Random pairs of starts at a given distance: the share of pairs with different fates, against the distance. Near "
            "a smooth boundary the share is proportional to the distance. Near a fractal boundary it decreases more slowly, "
            "as the distance to the power α, and the dimension of the boundary is 2 − α. Bars are 95 % intervals of the shares."
        ),
        "survival": (
            "The share of the interior starts that have not escaped by time t. For fully chaotic motion it decreases "
            "exponentially; orbits that stick to islands of regular motion escape by a slower law, a power of time, which is "
            "a straight line on these axes. A law is named only if it fits and is significantly more likely than the other "
            "one."
        ),
        "watch": (
            "Orbits move in the well, each in the colour of the exit that it will take. Grey orbits stay until t = 100. The map "
            "on (x, px) shows each orbit at its last passage of y = 0. The solid curve of the chart is the share still inside. "
            "The dashed curve is the law of mixed motion: flux through the exits over the volume inside. Orbits that stick to "
            "islands stay longer."
        ),
        **{name: measure.help for name, measure in MEASURES.items() if measure.help},
    }
)
"""Help texts by the names of the pictures and plots."""


def title_with_help(title: str, name: str, under_way: str = "") -> str:
    """Return HTML with a title, a button that opens the help text of `name`, and a note on what is being computed."""
    button = f"<button type='button' class='help' popovertarget='help-{name}' aria-label='About: {escape(title)}'>?</button>"
    note = f" <small role='status'>{escape(under_way)}</small>" if under_way else ""
    return f"<h2>{escape(title)} {button}{note}</h2><p id='help-{name}' class='help-text' popover>{escape(HELP_TEXTS[name])}</p>"
