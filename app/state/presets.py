"""Preset views: every kind of figure of Zotos (2014), details of the maps, and explanations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.state.view import Analysis, View, default_settings
from app.state.watched_starts import StartsFrom, WatchedStarts
from engine import Coordinate, ParameterAxis, Plane, Slice, System, TimeDirection, Window

GROUPS = ("The paper", "Places", "Explanations", "Other slices", "Other systems")
"""Kinds of figures in the paper, details found by zooming, analyses that explain both; slices and systems not in the paper."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A view with a title and a caption.

    Attributes
    ----------
    key
        Stem of the file of its thumbnail.
    title, caption
        Texts on the page: a few words, and a few sentences.
    group
        One of `GROUPS`.
    picture
        Picture of its thumbnail, one of `plots.layers.table.TITLES`.
    view
        The view.
    invitation
        One line of text if the view is offered before there is an orbit; empty for others.
    """

    key: str
    title: str
    caption: str
    group: str
    picture: str
    view: View
    invitation: str = ""


_PAPER, _PLACES, _EXPLANATIONS, _SLICES, _SYSTEMS = GROUPS

# Launched at right angles to the radius, against the rotation of the frame.
_RETROGRADE = Slice(Coordinate.X, Coordinate.Y, Coordinate.SPEED, 1, ((Coordinate.BETA, -0.5 * np.pi),))

# fmt: off
PRESETS: tuple[Preset, ...] = (
    Preset(
        key="two-exits", title="Two exits", group=_PAPER, picture="curves",
        view=View(System("I"), Plane.X_Y, 0.15, starts=((-0.21, -0.34), (0.3, -0.13))),
        caption="At the escape energy h = 1/8 the red equipotential opens at two saddles. Slightly above it the well has two "
        "gaps, and an unstable periodic orbit, the Lyapunov orbit, spans each gap: an orbit that crosses it outward "
        "never returns. One of the two orbits escapes through each gap.",
    ),
    Preset(
        key="four-exits", title="Four exits", group=_PAPER, picture="curves",
        invitation="0.09 apart, opposite exits",
        view=View(System("III"), Plane.X_Y, 0.30, t_max=1e3, starts=((-0.46, -0.79), (0.46, -0.79), (-0.46, -0.7), (0.46, -0.7))),
        caption="With the term x²y² the well opens at four saddles at the same energy, h = 1/4. On each side two orbits start "
        "only 0.09 apart and escape through opposite exits. Channels are numbered counterclockwise from the x axis.",
    ),
    Preset(
        key="basins-in-space", title="Basins of escape", group=_PAPER, picture="basins",
        view=View(System("II"), Plane.X_Y, 0.24, starts=((-0.12, -0.75), (0.67, -0.19), (0.37, -0.06))),
        caption="Each point is an orbit that starts there with upward velocity; its colour is the exit through which it "
        "escapes. In large regions of one colour neighbours escape through the same exit. In regions of mixed colours "
        "the smallest error of the start changes the exit.",
    ),
    Preset(
        key="basins-in-phase-space", title="Basins in phase space", group=_PAPER, picture="basins",
        view=View(System("I"), Plane.X_PX, 0.19, starts=((0.12, 0.35), (-0.16, -0.35), (-0.46, 0.0))),
        caption="Every orbit starts on the x axis; the axes show x and px. The two basins are interwoven spirals. In the grey "
        "islands orbits move on invariant tori and never escape, although both exits are open.",
    ),
    Preset(
        key="escape-times", title="Escape times", group=_PAPER, picture="times",
        view=View(System("III"), Plane.X_Y, 0.45, starts=((0.75, 0.69), (0.44, 0.06), (-0.12, 0.25))),
        caption="Light orbits escape early, dark ones late, on a logarithmic scale. Inside a basin an orbit crosses the well "
        "once or twice. Towards a basin boundary the escape time diverges, because an orbit that starts exactly on a "
        "boundary does not escape.",
    ),
    Preset(
        key="crossings", title="Counting crossings", group=_PAPER, picture="crossings",
        view=View(System("II"), Plane.X_PX, 0.22, starts=((0.2, 0.3), (0.3, -0.05), (0.45, 0.0), (0.3, 0.35), (0.55, -0.15))),
        caption="How often an orbit passes y = 0 upward before it escapes: the darker the colour, the more often, from none "
        "(lightest) to more than ten times (darkest). The bands of each count lie along those of the previous count, "
        "which builds up the fractal. The five orbits start on five different colours.",
    ),
    Preset(
        key="all-energies", title="All energies", group=_PAPER, picture="basins",
        invitation="Every energy in one picture",
        view=View(System("II"), Plane.X_H, 0.20, starts=((0.36, 0.36), (-0.33, 0.24), (0.63, 0.21), (0.63, 0.19))),
        caption="The vertical axis is the energy: each row is a well with its own exits. At the lowest energies, just above h "
        "= 1/6, grey islands lie in a chaotic sea. With rising energy they vanish one after the other, and wide arcs "
        "of one colour appear.",
    ),
    Preset(
        key="shares", title="Unequal shares", group=_PAPER, picture="basins",
        view=View(System("I"), Plane.X_PX, 0.30, starts=((0.26, 0.39), (0.04, -0.44), (-0.61, 0.0))),
        caption="At this energy less than 0.1 % of the orbits stay, and three quarters escape without a crossing. The "
        "potential is symmetric, yet 55 % escape through exit 1 and 45 % through exit 2, because every orbit "
        "starts upward.",
    ),
    Preset(
        key="regular-or-chaotic", title="Regular or chaotic", group=_PAPER, picture="characters",
        view=View(System("III"), Plane.X_PX, 0.26, resolution=112, layers=frozenset({"judge"}),
                  starts=((0.4, 0.2), (0.58, 0.0), (0.05, 0.58))),
        caption="Cyan orbits move on invariant tori, as averages over them show; magenta ones are chaotic, in thin layers "
        "between the tori, where SALI decreases to rounding error. A few pale ones show neither until t_max. The analysis takes "
        "a minute, and the picture is updated meanwhile.",
    ),
    Preset(
        key="super-sticky", title="A sticky orbit", group=_PAPER, picture="times",
        invitation="Regular for 20 000 time units, then gone",
        view=View(System("III"), Plane.X_PX, 0.26, starts=((0.2285, 0.5405),)),
        caption="For more than 20 000 time units, about two thousand periods, R² and SALI of this orbit look regular: it stays "
        "close to a torus. Then SALI drops, and soon after the orbit escapes. If the start is moved by 10⁻¹², it may "
        "escape at another time through another exit.",
    ),
    Preset(
        key="three-meet", title="Three basins with one boundary", group=_PLACES, picture="basins",
        invitation="Where two meet, so does the third",
        view=View(System("II"), Plane.X_Y, 0.26, window=Window(-0.2, 0.2, -0.5, -0.1),
                  starts=((0.11, -0.3), (0.115, -0.3), (0.12, -0.3))),
        caption="Wherever two colours seem to touch, the third lies between them at every magnification: all three basins "
        "share one boundary, the Wada property. The three orbits start 0.005 apart and escape through three exits.",
    ),
    Preset(
        key="crossroads", title="Four basins around a periodic orbit", group=_PLACES, picture="basins",
        view=View(System("III"), Plane.X_Y, 0.60, window=Window(-0.4, 0.4, -0.4, 0.4),
                  starts=((0.0, 0.2), (0.01, 0.2), (-0.01, 0.2), (-0.02, 0.2), (0.02, 0.2))),
        caption="Four basins surround the straight periodic orbit along the y axis, which is unstable at this energy. An orbit "
        "on x = 0 stays for ever; within 0.02 of it orbits escape through all four exits.",
    ),
    Preset(
        key="closer", title="Enlarged 3·10¹¹ times", group=_PLACES, picture="basins",
        invitation="Fractal down to 8·10⁻¹²",
        view=View(System("III"), Plane.X_Y, 0.60, window=Window(0.114912643464, 0.114912643472, 0.300643524596, 0.300643524604),
                  t_max=1e3, starts=(
                  (0.114912643469, 0.300643524601), (0.114912643467, 0.300643524599),
                  (0.114912643465, 0.300643524601), (0.114912643466, 0.300643524601),
                  )),
        caption="This window is 8·10⁻¹² wide and still shows a fractal structure in all four colours. Double precision limits "
        "further zooming: two neighbouring pixels would become the same number.",
    ),
    Preset(
        key="ceiling", title="Upper limit of stability", group=_PLACES, picture="basins",
        view=View(System("III"), Plane.X_H, 0.60, window=Window(-0.3, 0.3, 0.55, 0.65), t_max=1e3,
                  starts=((0.0, 0.6), (0.001, 0.57), (0.001, 0.6), (0.1, 0.57), (0.1, 0.59))),
        caption="A small sideways displacement of the orbit along the y axis obeys Mathieu's equation, which is stable up to h "
        "= 0.5817: there the grey region ends abruptly. Above it the straight orbit still exists, but all orbits near "
        "it escape.",
    ),
    Preset(
        key="needles", title="Resonances", group=_PLACES, picture="basins",
        view=View(System("III"), Plane.X_H, 0.45, window=Window(-0.6, 0.6, 0.35, 0.6), t_max=1e3,
                  starts=((0.2, 0.4), (0.3, 0.45), (0.38, 0.46), (0.59, 0.47))),
        caption="In the grey region nearly all orbits move on tori around the straight periodic orbit along the y axis. Narrow "
        "tongues of escape enter it from both sides: tori break up first at energies where their two frequencies are "
        "close to a simple ratio.",
    ),
    Preset(
        key="last-islands", title="The last islands", group=_PLACES, picture="basins",
        view=View(System("II"), Plane.X_H, 0.20, window=Window(-0.3, 0.5, 0.168, 0.23), t_max=1e4,
                  starts=((0.0, 0.19), (-0.07, 0.2), (0.18, 0.2))),
        caption="With rising energy regular motion shrinks to a chain of islands. At its narrow parts hardly any torus is left "
        "around the central periodic orbit; at slightly higher energies the islands grow again. Few islands reach h = "
        "0.21.",
    ),
    Preset(
        key="coast", title="A fractal boundary", group=_PLACES, picture="basins",
        view=View(System("I"), Plane.X_H, 0.25, window=Window(-0.5, -0.3, 0.18, 0.28), t_max=1e4,
                  starts=((-0.49, 0.2), (-0.45, 0.24), (-0.38, 0.227), (-0.305, 0.278))),
        caption="The boundary between bounded and escaping orbits is not smooth: it has capes, with smaller capes on them. Red "
        "and green tongues enter the bays and become thinner with depth.",
    ),
    Preset(
        key="ripples", title="Escape times near an island", group=_PLACES, picture="times",
        view=View(System("III"), Plane.X_PX, 0.45, window=Window(-0.25, 0.25, -0.12, 0.12),
                  starts=((0.05, 0.05), (0.11, -0.07), (0.16, 0.09), (0.21, 0.115))),
        caption="The island contains the orbits near the straight periodic orbit along the y axis. Outside it the escape times "
        "oscillate, and the oscillations accumulate at its edge: orbits that start there move along the edge for a few "
        "periods before they escape.",
    ),
    Preset(
        key="wings", title="Mirror images", group=_PLACES, picture="times",
        view=View(System("III"), Plane.X_Y, 0.45, window=Window(0.1, 0.6, -0.25, 0.25), t_max=1e4,
                  starts=((0.13, 0.0), (0.37, -0.23), (0.4, 0.17), (0.59, 0.0))),
        caption="The two grey regions are mirror images: an orbit reversed in time and reflected is an orbit again, and a "
        "bounded orbit is bounded in both directions of time. The escape times around them have no such symmetry, "
        "because an orbit escapes at different times in the future and in the past.",
    ),
    Preset(
        key="owl", title="Closed exits", group=_PLACES, picture="characters",
        invitation="Islands in a chaotic sea",
        view=View(System("I"), Plane.X_PX, 0.12, resolution=112, layers=frozenset({"judge"}),
                  starts=((0.12, 0.155), (-0.1, 0.24), (0.0, 0.28), (0.2, 0.0))),
        caption="Below the escape energy of 1/8 no orbit escapes, but there is chaos (magenta) before the exits open. The cyan "
        "islands in it form chains: the first orbit visits three islands in turn, the second alternates between two. "
        "The analysis takes a minute.",
    ),
    Preset(
        key="feather", title="Bands of crossings", group=_PLACES, picture="crossings",
        view=View(System("II"), Plane.X_PX, 0.20, window=Window(-0.2, 0.3, -0.3, 0.2),
                  starts=((-0.03, -0.29), (-0.08, 0.12), (0.03, -0.03), (-0.04, 0.0))),
        caption="In the lightest band orbits escape without a crossing, in the darker ones next to it after one or two, and "
        "between the bands later. In the middle a small island remains: its orbit alternates between this island and another "
        "one near x = 0.7.",
    ),
    Preset(
        key="ajar", title="Just above the escape energy", group=_PLACES, picture="basins",
        view=View(System("II"), Plane.X_Y, 0.168, t_max=1e3, starts=((0.79, 0.1), (-0.49, 0.8), (-0.33, -0.05), (-0.06, 0.05))),
        caption="Only 0.0013 above the escape energy the exits are narrow and the colours are finely mixed. More than half of "
        "the orbits have not escaped by t = 1000 and are grey; with t_max ten times larger most of them escape.",
    ),
    Preset(
        key="storm", title="Sticky edge of a regular region", group=_PLACES, picture="times",
        view=View(System("I"), Plane.X_PX, 0.15, window=Window(-0.1, 0.5, -0.1, 0.5), t_max=1e4,
                  starts=((0.05, 0.31), (0.11, 0.01), (0.2, 0.46), (0.48, 0.2))),
        caption="In the light region in the middle orbits escape at once. Around it bands of increasing escape time approach "
        "the grey edge of a regular region, where orbits may stay for thousands of time units.",
    ),
    Preset(
        key="section", title="The section of Hénon and Heiles", group=_SLICES, picture="basins",
        view=View(System("HH"), Plane.Y_PY, 0.18, t_max=1e4,
                  starts=((0.05, 0.0), (0.61, 0.0), (0.7, 0.0), (-0.2, 0.0), (0.2, 0.0))),
        caption="Hénon and Heiles drew their orbits in this plane, y and py where an orbit passes x = 0 to the right. At their "
        "energies all orbits are bounded; slightly above 1/6 only the grey islands are left of them, and all around an orbit "
        "leaves through one of the three exits.",
    ),
    Preset(
        key="threads", title="Stable manifolds", group=_EXPLANATIONS, picture="curves",
        view=View(System("III"), Plane.X_PX, 0.45, t_max=1e4, layers=frozenset({"manifolds"}), starts=((0.1, 0.6), (0.55, 0.12))),
        caption="Orbits that approach a Lyapunov orbit for ever form a tube, its stable manifold. The surface of section cuts "
        "the tubes in these curves, and each curve separates starts that escape from starts that turn back. The basins "
        "have no other boundaries.",
    ),
    Preset(
        key="passages", title="Origin and exit", group=_EXPLANATIONS, picture="origins",
        view=View(System("III"), Plane.X_PX, 0.35, t_max=1e4, layers=frozenset({"origins"}), starts=((0.3, 0.45), (-0.3, -0.45))),
        caption="Each orbit is integrated in both directions of time: the hue shows the exit, the tone the entrance. Large "
        "tiles of one colour are fast passages with one history; between them future and past both depend sensitively "
        "on the start. Grey orbits neither came from an exit nor leave through one.",
    ),
    Preset(
        key="parting", title="Where orbits part", group=_EXPLANATIONS, picture="descriptors",
        view=View(System("II"), Plane.X_PX, 0.2, t_max=1e4, layers=frozenset({"descriptor"}),
                  settings={**default_settings(), "descriptor_direction": TimeDirection.FORWARD, "descriptor_time": 20.0},
                  starts=((0.2, 0.3), (0.25, 0.1))),
        caption="The colour is the square root of the speed, integrated along each orbit up to t = 20 or its exit. Where it "
        "changes abruptly, neighbours part: there run stable manifolds, found without the periodic orbits that they belong to.",
    ),
    Preset(
        key="doubt", title="Doubtful pixels", group=_EXPLANATIONS, picture="basins",
        view=View(System("I"), Plane.X_PX, 0.17, t_max=1e4, layers=frozenset({"trust"}), starts=((0.31, 0.05), (-0.2, 0.2))),
        caption="Every pixel with a neighbour of another colour was computed again, from a start moved by 10⁻¹¹ and with "
        "another tolerance. The black and white ones changed: the exit of these orbits depends on rounding. The rest of the "
        "picture and its shares are not affected.",
    ),
    Preset(
        key="measures", title="How fractal?", group=_EXPLANATIONS, picture="basins",
        view=View(System("II"), Plane.X_PX, 0.25, t_max=1e4, analysis=Analysis.MEASURES, starts=((0.35, 0.05), (-0.3, 0.1))),
        caption="Hénon and Heiles' potential with three exits. The measures below state how mixed the colours are, whether all "
        "three basins share one boundary, and how slowly a more accurate start reduces the uncertainty: press the "
        "button there to compute pairs of orbits.",
    ),
    Preset(
        key="draining", title="A draining well", group=_EXPLANATIONS, picture="basins",
        view=View(System("III"), Plane.X_PX, 0.45, t_max=1e4, analysis=Analysis.WATCH),
        caption="Five thousand orbits start all over the well, in the colours of the exits that they will take. At first they "
        "leave as fast as flux over volume says: at t = 5 a little more than four in ten are left. At t = 50 it is one in "
        "seven, near islands and in them, where mixed motion would have left one in four thousand.",
    ),
    Preset(
        key="torn", title="Torn four ways", group=_EXPLANATIONS, picture="basins",
        view=View(System("III"), Plane.X_PX, 0.45, t_max=1e4, analysis=Analysis.WATCH,
                  watched=WatchedStarts(StartsFrom.DISC, 5000, 1, -3.0), starts=((-0.45, 0.175),)),
        caption="Five thousand orbits start within a thousandth of the picture from one another. Until t = 15 all of them stay "
        "inside, stretched into a thread and folded; then they leave through all four exits, a sixth to three tenths through "
        "each.",
    ),
    Preset(
        key="doors", title="Tubes that lead out", group=_EXPLANATIONS, picture="basins",
        view=View(System("II"), Plane.X_PX, 0.25, t_max=1e4, analysis=Analysis.WATCH,
                  watched=WatchedStarts(StartsFrom.TUBES, 5000, 1)),
        caption="Orbits that come close to an exit form a tube. Of these, half start just inside a tube and leave when they come "
        "to the exit, at t = 9; the others start just outside and turn back there. On the map their passages of the section draw "
        "the boundaries of the basins.",
    ),
    Preset(
        key="kept", title="An island keeps its own", group=_EXPLANATIONS, picture="times",
        view=View(System("III"), Plane.X_PX, 0.45, t_max=1e4, analysis=Analysis.WATCH,
                  watched=WatchedStarts(StartsFrom.DISC, 5000, 1, -1.0), starts=((0.22, 0.0),)),
        caption="Five thousand orbits start at the end of an island of regular motion. At t = 20 one in a hundred has left, at "
        "t = 100 half of them: they stick to the island for long. One in seven lies on it, and is still there at t = 100 000.",
    ),
    Preset(
        key="tangential", title="Thrown sideways", group=_SLICES, picture="basins",
        view=View(System("HH"), Plane.TANGENTIAL, 0.2, t_max=1e4, starts=((-0.3, 0.1), (0.1, -0.2), (0.0, 0.1))),
        caption="Every orbit of this picture starts at right angles to the line from the centre, with all its energy: the plane "
        "in which Aguirre, Vallejo and Sanjuán showed in 2001 that the three basins of Hénon and Heiles share one boundary.",
    ),
    Preset(
        key="launch", title="A throw in any direction", group=_SLICES, picture="basins",
        view=View(System("III"), Slice(Coordinate.THETA, Coordinate.H), 0.45, t_max=1e4,
                  starts=((0.8, 0.3), (2.35, 0.3), (-2.35, 0.3), (-0.78, 0.3), (0.0, 0.35))),
        caption="All orbits start in the middle of the well. To the right the direction of the throw turns, upward its energy "
        "grows. Just above the escape energy only a throw straight at an exit leaves; the four windows widen with the energy, "
        "until few throws between them stay inside.",
    ),
    Preset(
        key="strength", title="From order to escape", group=_SLICES, picture="basins",
        view=View(System("I"), Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))), 0.2, t_max=1e4,
                  starts=((0.1, 0.7), (0.1, 1.5), (0.55, 1.2), (-0.5, 1.9))),
        caption="The energy stays the same, and upward grows ε, the strength of the perturbation. Where 1/(8 ε²) falls below the "
        "energy, the exits open: the islands of bounded orbits shrink, split at resonances and are gone.",
    ),
    Preset(
        key="two-stars", title="Between two stars", group=_SYSTEMS, picture="basins",
        view=View(System("Copenhagen"), _RETROGRADE, -1.6, window=Window(-2.0, 2.0, -2.0, 2.0), t_max=1e3,
                  starts=((0.3, 0.1), (0.45, 0.5), (1.5, 0.5), (-0.7, 0.0))),
        caption="Two equal stars go around each other, and the picture turns with them. A light body starts against this "
        "rotation: an eighth of the bodies fall into each star, most leave the picture for good, and those in the grey "
        "islands stay with one star. The white places need more energy.",
    ),
    Preset(
        key="moon", title="Around the Moon", group=_SYSTEMS, picture="basins",
        view=View(System("Earth-Moon"), _RETROGRADE, -1.095, t_max=1e2, starts=((0.16, -0.03), (-0.14, 0.02), (0.05, 0.0))),
        caption="The Moon is in the middle, the Earth far to the left. Above the energies of L1 and L2 two necks are open. A "
        "retrograde start near the Moon stays; further out half of all starts fall onto the Moon, and few find a neck.",
    ),
    Preset(
        key="planet", title="A planet and its star", group=_SYSTEMS, picture="basins",
        view=View(System("Hill"), Plane.X_PX, -2.0, t_max=1e2, starts=((0.4, 0.0), (0.3, 1.0), (0.2, 2.0), (-0.2, 0.0))),
        caption="Hill's problem: the surroundings of a planet that goes around a far star. One body leaves on each side, one "
        "falls into the planet, and one circles the planet against the rotation, which holds best: the island at x < 0.",
    ),
    Preset(
        key="cluster", title="Stars leave a cluster", group=_SYSTEMS, picture="basins",
        view=View(System("Star cluster"), Plane.X_PX, -1.75, t_max=1e3, starts=((0.5, 0.5), (0.1, 2.0), (-0.2, 0.0))),
        caption="A star cluster in the tide of its galaxy, seen in the frame that turns with it. The Coriolis force makes left "
        "and right different: retrograde stars, at x < 0, fill a large island, prograde ones a small one. About a third leave "
        "on each side.",
    ),
    Preset(
        key="bar", title="The ends of a bar", group=_SYSTEMS, picture="basins",
        view=View(System("Barred galaxy"), Plane.X_PX, -3200.0, t_max=1e2, starts=((5.0, -20.0), (5.0, 0.0), (-2.0, 0.0))),
        caption="A barred galaxy, after Jung and Zotos (2016): stars leave over both ends of the bar and feed its spiral arms. A "
        "quarter of these starts is kept until t = 100.",
    ),
    Preset(
        key="spindle", title="A logarithmic bar", group=_SYSTEMS, picture="basins",
        view=View(System("Logarithmic bar"), Plane.X_PX, -0.44, t_max=1e3, starts=((0.7, 0.1), (0.3, 0.8), (-0.2, 0.0))),
        caption="The potential of a flat rotation curve, flattened and turning. Most starts are kept by islands; the others "
        "leave at the ends of the long axis.",
    ),
)
"""All presets in the order of the page."""
# fmt: on
