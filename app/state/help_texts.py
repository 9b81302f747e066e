"""What each picture and pane shows and how to read it, for whoever sees it the first time."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from types import MappingProxyType

HELP_TEXTS: Mapping[str, str] = MappingProxyType(
    {
        "curves": (
            "The limiting curve bounds the starts that exist at this energy; on (x, y) it is the zero-velocity curve V = h, "
            "on which an orbit would stand still. Above the escape energy that curve is open, with a gap at each saddle of "
            "the potential. Across each gap swings an unstable periodic orbit, the Lyapunov orbit: an orbit that passes it "
            "outward never comes back, so it marks the exit."
        ),
        "basins": (
            "Each pixel is a start, and its colour tells through which exit channel its orbit leaves. Inside a broad patch "
            "all neighbours leave the same way. Elsewhere the patches are interwoven at every scale: zoom in, and starts as "
            "close as you like still leave through different exits. Bounded orbits have not left by t_max; many of them never "
            "will."
        ),
        "times": (
            "The escape time is the moment at which an orbit crosses a Lyapunov orbit outward. It is short and smooth inside "
            "the basins and grows without limit towards their fractal boundaries. Close to islands of bounded orbits it is "
            "long, too: orbits stick to an island's edge before they get away. The scale of the bar is logarithmic."
        ),
        "crossings": (
            "How often an orbit passes the axis y = 0 upward before it leaves; the start itself does not count. None at all "
            "is a direct escape. The count is a clock that ticks about once in each round of the well, so its bands follow "
            "the escape time, and the bands get ever thinner towards a basin boundary."
        ),
        "characters": (
            "Here the bounded orbits are sorted into regular and chaotic ones by SALI, carried along until t_max. Regular "
            "orbits form islands, which nothing leaves or enters. A chaotic orbit that is still inside is usually sticky: it "
            "lingers at an island's edge and may leave long after t_max. Orbits that escape are not judged."
        ),
        "origins": (
            "Each orbit followed both ways in time. The hue tells through which exit it leaves, as in the basins; the tone "
            "tells through which it came in. The exit changes across the stable manifolds of the Lyapunov orbits, the origin "
            "across the unstable ones, and where both kinds of line crowd together lies the chaotic saddle, the orbits that "
            "stay for ever."
        ),
        "path": (
            "The way of each chosen orbit through the (x, y) plane, from its start, with the zero-velocity curve and the "
            "Lyapunov orbits at the exits. An escaping orbit is drawn up to the exit that it passes. A regular one keeps to a "
            "tidy woven band; a chaotic one wanders with no pattern. Very long paths are shaded by how often they come by."
        ),
        "sali": (
            "Two tiny deviations from the orbit are carried along with it. Chaos turns both into the same direction, up to "
            "the sign, and SALI, which measures the angle between them, drops exponentially until only rounding is left, at "
            "about 1e-16. On a regular orbit it stays up or falls like a power of time, a straight line on these axes. A "
            "bounded orbit counts as chaotic once SALI is 1e-7 or less."
        ),
        "exponent": (
            "How fast a tiny deviation has grown on average until t, per unit of time. On a regular orbit it falls all the "
            "time, like ln t over t, a line going down on these axes. On a chaotic one it levels off at the maximal Lyapunov "
            "exponent; its inverse is the time in which an error grows by a factor of e."
        ),
        "r2": (
            "The squared distance from the centre of the well. A regular orbit goes up and down between fixed limits. An "
            "escaping one ends at the value at which it passes its exit. A sticky orbit looks bounded for a long time, then "
            "its range suddenly widens and it leaves."
        ),
        "distance": (
            "How far two orbits are apart in position and momentum together, on a logarithmic scale. Neighbours in a chaotic "
            "region part exponentially, which is a climbing straight line here, until they are as far apart as the well "
            "allows. Regular neighbours part only about in proportion to time, a curve that flattens. The steeper the climb, "
            "the sooner a small error of the start matters."
        ),
        "histogram": (
            "How many starts leave when; each bin is the same factor of time wide. The peak is the typical stay. The tail on "
            "the right comes from the fractal boundaries and from orbits that stick to islands. Bounded orbits are not in it."
        ),
        "probabilities": (
            "Of the orbits that are still inside at their n-th upward crossing of y = 0, the share that leaves before the "
            "next one; n = 0 is the share of direct escapes. Were the motion inside well mixed, the chance would be the same "
            "each time. Bounded orbits stay in the count, so where there are any, it goes to zero."
        ),
        "uncertainty": (
            "Pairs of starts a distance apart, picked at random: the share of pairs that end differently, against the "
            "distance. Near a smooth boundary half the distance makes half as many pairs uncertain. Near a fractal one it "
            "falls more slowly, as distance to the power α: to know the exit of twice as many starts, the start must be known "
            "far more than twice as well. The boundary's dimension is 2 − α."
        ),
        "survival": (
            "The share of the interior starts still inside at time t. Where motion is chaotic throughout, it falls "
            "exponentially; orbits that stick to islands of regular motion leave by a slower law, a power of time, which is a "
            "straight line on these axes. A law is named only when it fits by itself and is surely the likelier one."
        ),
        "shares": (
            "How the interior starts divide between the exits, and how many stay, at each energy. Just above the escape "
            "energy nearly everything stays; the islands of bounded orbits shrink and vanish one after the other as the "
            "energy rises."
        ),
        "entropies": (
            "How mixed the basins are in small boxes of 5 by 5 pixels: S_b over all boxes, S_bb over those with more than one "
            "end. A smooth boundary between two basins gives S_bb at most ln 2, the dashed line; above it, boundaries are "
            "fractal at the scale of a box. Below it nothing is said."
        ),
        "exponents": (
            "How slowly better knowledge of the start removes doubt about the exit: the exponent α of the uncertain share, "
            "measured with new pairs of starts at each energy. Close to 0, nothing helps: the boundary nearly fills the "
            "plane. Close to 1, boundaries are smooth. Bars are 95 % intervals."
        ),
        "escapes": (
            "How long those that leave stay, on average and for the middle one of them. A mean far above the median comes "
            "from a few sticky orbits, and then it depends on how long one waits."
        ),
    }
)
"""By the names of the pictures and panes."""

# Colours of their own would be lost in one of the themes.
_SMALL = "font-size:13px;line-height:1.45;color:inherit"


def help_details(name: str) -> str:
    """HTML: a question that unfolds to the help text of a picture or pane."""
    summary = '<summary style="cursor:pointer;width:max-content">What is this?</summary>'
    return f'<details style="{_SMALL}">{summary}<p style="margin:4px 0">{escape(HELP_TEXTS[name])}</p></details>'
