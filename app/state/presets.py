"""Views worth a look, each one click away: every kind of figure of Zotos (2014), and places in the maps."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from engine import Plane, Window

GROUPS = ("The paper", "Places", "AnalysisPresenter")
"""The kinds of figures that the paper has, places that were found by zooming, and what explains both."""

_SHOWN = ("key", "title", "caption", "group", "picture")


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A view with a name, and what it teaches.

    Attributes
    ----------
    key
        Its name in file names.
    title, caption
        What a visitor reads: a few words, and a few sentences.
    group
        One of `GROUPS`.
    picture
        Which of `app.rendering.map_images.TITLES` stands on its thumbnail.
    case, plane, energy, window, t_max, resolution, starts, judge, trust, manifolds, origins, measures
        As in `ViewState`.
    """

    key: str
    title: str
    caption: str
    group: str
    picture: str
    case: str
    plane: Plane
    energy: float
    window: Window | None = None
    t_max: float = 1e5
    resolution: int = 225
    starts: tuple[tuple[float, float], ...] = ()
    judge: bool = False
    trust: bool = False
    manifolds: bool = False
    origins: bool = False
    measures: bool = False

    def values(self) -> dict[str, Any]:
        """The values of the view state's attributes that show it."""
        return {part.name: getattr(self, part.name) for part in fields(self) if part.name not in _SHOWN}


_PAPER, _PLACES, _WHY = GROUPS

# fmt: off
PRESETS: tuple[Preset, ...] = (
    Preset(
        key="two-exits", title="Two ways out", group=_PAPER, picture="curves",
        case="I", plane=Plane.X_Y, energy=0.15, starts=((-0.21, -0.34), (0.3, -0.13)),
        caption="The red line of equal potential is the lowest one with a way out, h = 1/8. A little above it the well has two "
        "gaps, and across each hangs an unstable periodic orbit: whoever crosses it outward never comes back. One orbit leaves "
        "through each gap.",
    ),
    Preset(
        key="four-exits", title="Four ways out", group=_PAPER, picture="curves",
        case="III", plane=Plane.X_Y, energy=0.30, t_max=1e3,
        starts=((-0.46, -0.79), (0.46, -0.79), (-0.46, -0.7), (0.46, -0.7)),
        caption="With x²y² the well opens at four corners at once, as soon as h exceeds 1/4. On either side two orbits start "
        "only 0.09 apart, and leave by opposite corners. Channels are counted counterclockwise from the x axis.",
    ),
    Preset(
        key="basins-in-space", title="Basins of escape", group=_PAPER, picture="basins",
        case="II", plane=Plane.X_Y, energy=0.24, starts=((-0.12, -0.75), (0.67, -0.19), (0.37, -0.06)),
        caption="Each point is an orbit that starts there, going up; its colour is the exit that it takes. In the wide patches "
        "neighbours share their fate. Where the colours are braided, the smallest error in the start changes the exit.",
    ),
    Preset(
        key="basins-in-phase-space", title="Basins in phase space", group=_PAPER, picture="basins",
        case="I", plane=Plane.X_PX, energy=0.19, starts=((0.12, 0.35), (-0.16, -0.35), (-0.46, 0.0)),
        caption="Now every orbit starts on the x axis; across is its place, upward its speed along x. Two basins curl about each "
        "other. In the grey islands orbits wind round tori and never leave, though both doors stand open.",
    ),
    Preset(
        key="escape-times", title="How long it takes", group=_PAPER, picture="times",
        case="III", plane=Plane.X_Y, energy=0.45, starts=((0.75, 0.69), (0.44, 0.06), (-0.12, 0.25)),
        caption="Light orbits leave at once, dark ones late, on a logarithmic scale. Inside a basin a swing or two is enough. "
        "Towards its edge the time grows without bound, for an orbit that starts exactly on an edge belongs to no exit.",
    ),
    Preset(
        key="crossings", title="Counting swings", group=_PAPER, picture="crossings",
        case="II", plane=Plane.X_PX, energy=0.22, starts=((0.2, 0.3), (0.3, -0.05), (0.45, 0.0), (0.3, 0.35), (0.55, -0.15)),
        caption="How often does an orbit pass y = 0 upward before it leaves: never (red), once (blue), twice (magenta), up to "
        "ten times (orange), or more (green)? The stripes of each count line those of the one before: so the fractal is woven, "
        "swing by swing. Each of the five orbits starts on a colour of its own.",
    ),
    Preset(
        key="all-energies", title="Every energy at once", group=_PAPER, picture="basins",
        case="II", plane=Plane.X_H, energy=0.20, starts=((0.36, 0.36), (-0.33, 0.24), (0.63, 0.21), (0.63, 0.19)),
        caption="Here height is energy: each row is a well of its own, with its own exits. At the bottom, just above h = 1/6, "
        "grey islands lie in noise. Further up they die out one by one, and wide arches of one colour take over.",
    ),
    Preset(
        key="shares", title="Unequal doors", group=_PAPER, picture="basins",
        case="I", plane=Plane.X_PX, energy=0.30, starts=((0.26, 0.39), (0.04, -0.44), (-0.61, 0.0)),
        caption="With energy to spare less than 0.1 % of the orbits stay, and three quarters leave without a single swing. The "
        "well is symmetric, yet 55 % leave through channel 1 and 45 % through channel 2: every orbit starts upward, and that "
        "breaks the tie.",
    ),
    Preset(
        key="regular-or-chaotic", title="Order or chaos", group=_PAPER, picture="characters", judge=True, resolution=113,
        case="III", plane=Plane.X_PX, energy=0.26, starts=((0.4, 0.2), (0.58, 0.0), (0.05, 0.58)),
        caption="SALI tells two kinds of bounded orbits apart. The cyan ones wind round tori; the magenta ones wander through "
        "thin layers between the tori, where SALI falls to nothing. Judging them all takes a minute, and the picture fills in "
        "meanwhile.",
    ),
    Preset(
        key="super-sticky", title="An orbit that clings", group=_PAPER, picture="times",
        case="III", plane=Plane.X_PX, energy=0.26, starts=((0.2285, 0.5405),),
        caption="For more than 20 000 time units, some two thousand swings, neither R² nor SALI betrays this orbit: it sticks to "
        "a torus. Then SALI dives, and soon after the orbit is out. Move the start by 10⁻¹², and it may leave at another "
        "time, by another door.",
    ),
    Preset(
        key="three-meet", title="Where three basins meet", group=_PLACES, picture="basins",
        case="II", plane=Plane.X_Y, energy=0.26, window=Window(-0.2, 0.2, -0.5, -0.1),
        starts=((0.11, -0.3), (0.115, -0.3), (0.12, -0.3)),
        caption="Wherever two colours seem to touch, the third lies between them, however closely one looks: all three basins "
        "share one boundary, as Wada's lakes do. Three orbits that start 0.005 apart leave by three exits.",
    ),
    Preset(
        key="crossroads", title="Crossroads", group=_PLACES, picture="basins",
        case="III", plane=Plane.X_Y, energy=0.60, window=Window(-0.4, 0.4, -0.4, 0.4),
        starts=((0.0, 0.2), (0.01, 0.2), (-0.01, 0.2), (-0.02, 0.2), (0.02, 0.2)),
        caption="Four basins are braided around the orbit that swings straight along the y axis. At this energy it is unstable: "
        "whoever starts on x = 0 stays there for ever, and within 0.02 beside it all four exits can be had.",
    ),
    Preset(
        key="closer", title="300 000 000 000 times closer", group=_PLACES, picture="basins",
        case="III", plane=Plane.X_Y, energy=0.60, t_max=1e3,
        window=Window(0.114912643464, 0.114912643472, 0.300643524596, 0.300643524604),
        starts=(
            (0.114912643469, 0.300643524601), (0.114912643467, 0.300643524599),
            (0.114912643465, 0.300643524601), (0.114912643466, 0.300643524601),
        ),
        caption="This window is 8·10⁻¹² wide, and still it holds ribbons within ribbons, in all four colours. Some way further "
        "down double precision ends: two neighbouring pixels would be the same number.",
    ),
    Preset(
        key="ceiling", title="A ceiling for stability", group=_PLACES, picture="basins",
        case="III", plane=Plane.X_H, energy=0.60, window=Window(-0.3, 0.3, 0.55, 0.65), t_max=1e3,
        starts=((0.0, 0.6), (0.001, 0.57), (0.001, 0.6), (0.1, 0.57), (0.1, 0.59)),
        caption="A small push sideways on the orbit along the y axis obeys Mathieu's equation, which is stable up to h = 0.5817: "
        "there the grey ends, as if cut off. Above it the straight orbit still exists, but every neighbour of it is thrown out.",
    ),
    Preset(
        key="needles", title="Needles of escape", group=_PLACES, picture="basins",
        case="III", plane=Plane.X_H, energy=0.45, window=Window(-0.6, 0.6, 0.35, 0.6), t_max=1e3,
        starts=((0.2, 0.4), (0.3, 0.45), (0.38, 0.46), (0.59, 0.47)),
        caption="In the grey nearly all orbits wind on tori around the straight swing along the y axis. Needles of escape pierce "
        "them from either side: tori break sooner at energies where their two frequencies come close to a simple ratio.",
    ),
    Preset(
        key="last-islands", title="The last islands", group=_PLACES, picture="basins",
        case="II", plane=Plane.X_H, energy=0.20, window=Window(-0.3, 0.5, 0.168, 0.23), t_max=1e4,
        starts=((0.0, 0.19), (-0.07, 0.2), (0.18, 0.2)),
        caption="As the energy rises, regular motion retreats to islands that hang on each other like drops. At their waists "
        "hardly a torus is left around the periodic orbit in the middle; a little higher they swell again. Few islands reach "
        "h = 0.21.",
    ),
    Preset(
        key="coast", title="A coast with capes", group=_PLACES, picture="basins",
        case="I", plane=Plane.X_H, energy=0.25, window=Window(-0.5, -0.3, 0.18, 0.28), t_max=1e4,
        starts=((-0.49, 0.2), (-0.45, 0.24), (-0.38, 0.227), (-0.305, 0.278)),
        caption="The border between staying and leaving is no smooth line: it has capes, and on the capes smaller ones. Red and "
        "green tongues from above reach as deep into the bays as they can, thinner and thinner.",
    ),
    Preset(
        key="ripples", title="Ripples round an island", group=_PLACES, picture="times",
        case="III", plane=Plane.X_PX, energy=0.45, window=Window(-0.25, 0.25, -0.12, 0.12),
        starts=((0.05, 0.05), (0.11, -0.07), (0.16, 0.09), (0.21, 0.115)),
        caption="The island holds the orbits near the straight swing along the y axis. Outside it escape times ripple, and the "
        "ripples crowd together towards the shore: what starts there is led along the shore for a few swings more before it "
        "gets away.",
    ),
    Preset(
        key="wings", title="Wings", group=_PLACES, picture="times",
        case="III", plane=Plane.X_Y, energy=0.45, window=Window(0.1, 0.6, -0.25, 0.25), t_max=1e4,
        starts=((0.13, 0.0), (0.37, -0.23), (0.4, 0.17), (0.59, 0.0)),
        caption="The two grey lenses are mirror images: an orbit run backwards and turned upside down is an orbit again, and one "
        "that stays has stayed for ever. The escape times around them know no such mirror, for an orbit leaves into the future "
        "and into the past at different times.",
    ),
    Preset(
        key="owl", title="The owl behind closed doors", group=_PLACES, picture="characters", judge=True, t_max=1e4,
        case="I", plane=Plane.X_PX, energy=0.12, starts=((0.12, 0.155), (-0.1, 0.24), (0.0, 0.28), (0.2, 0.0)),
        caption="Below the escape energy of 1/8 nobody leaves, but chaos (magenta) is there before the doors open. The cyan "
        "islands in it form chains: the first orbit hops round three islands in turn, the second to and fro between two. Judging "
        "takes half a minute.",
    ),
    Preset(
        key="feather", title="A feather of swings", group=_PLACES, picture="crossings",
        case="II", plane=Plane.X_PX, energy=0.20, window=Window(-0.2, 0.3, -0.3, 0.2),
        starts=((-0.03, -0.29), (-0.08, 0.12), (0.03, -0.03), (-0.04, 0.0)),
        caption="The red barb leaves without a swing, blue and magenta ones after one or two, and what lies between them waits "
        "longer. In the middle a sliver of an island survives: its orbit visits this one and another near x = 0.7 by turns.",
    ),
    Preset(
        key="ajar", title="Doors ajar", group=_PLACES, picture="basins",
        case="II", plane=Plane.X_Y, energy=0.168, t_max=1e3,
        starts=((0.79, 0.1), (-0.49, 0.8), (-0.33, -0.05), (-0.06, 0.05)),
        caption="Only 0.0013 above the escape energy the doors are narrow, and the colours mix like salt and pepper. More than "
        "half of the orbits have found no door by t = 1000 and are grey; let t_max grow tenfold, and most of the grey goes.",
    ),
    Preset(
        key="storm", title="Storm off a sticky shore", group=_PLACES, picture="times",
        case="I", plane=Plane.X_PX, energy=0.15, window=Window(-0.1, 0.5, -0.1, 0.5), t_max=1e4,
        starts=((0.05, 0.31), (0.11, 0.01), (0.2, 0.46), (0.48, 0.2)),
        caption="In the calm light eye orbits leave at once. Outside, arms of ever longer delay wind towards the grey shore of a "
        "regular region, and where they reach it orbits may linger for thousands of time units.",
    ),
    Preset(
        key="threads", title="Where the colours meet", group=_WHY, picture="curves", manifolds=True,
        case="III", plane=Plane.X_PX, energy=0.45, t_max=1e4, starts=((0.1, 0.6), (0.55, 0.12)),
        caption="Orbits that neither leave nor turn back at an exit, but stay with its Lyapunov orbit for ever, fill a tube: its "
        "stable manifold. Cut by the section the tubes are these threads, and each thread parts starts that leave from starts "
        "that turn back. The basins have no other boundaries.",
    ),
    Preset(
        key="passages", title="From where to where", group=_WHY, picture="origins", origins=True,
        case="III", plane=Plane.X_PX, energy=0.35, t_max=1e4, starts=((0.3, 0.45), (-0.3, -0.45)),
        caption="Each orbit followed both ways: the hue is the exit, the tone the entrance. Smooth tiles are quick passages with "
        "one history; in the fabric between them the future and the past are both a lottery. What is grey came from nowhere and "
        "goes nowhere.",
    ),
    Preset(
        key="doubt", title="Which pixels to believe", group=_WHY, picture="basins", trust=True,
        case="I", plane=Plane.X_PX, energy=0.17, t_max=1e4, starts=((0.31, 0.05), (-0.2, 0.2)),
        caption="Every pixel with a neighbour of another colour was computed again, from a start moved by 0.00000000001 and at "
        "another tolerance. Black ones changed: no computer tells where these orbits go. The picture as a whole, and its shares, "
        "are none the worse for it.",
    ),
    Preset(
        key="measures", title="How fractal?", group=_WHY, picture="basins", measures=True,
        case="II", plane=Plane.X_PX, energy=0.25, t_max=1e4, starts=((0.35, 0.05), (-0.3, 0.1)),
        caption="Hénon and Heiles' potential with three exits. The measures below say how mixed the colours are, whether all "
        "three share one boundary, and how slowly better knowledge of the start helps: press the button there to have pairs of "
        "orbits followed.",
    ),
)
"""In the order in which they are shown."""
# fmt: on
