"""Pictures that show a map alone, and pictures that compare the map with another view."""

from __future__ import annotations

from engine import Evidence, Fate
from plots.layers.picture import Legend, Picture, ShownMap
from plots.pictures.palette import DIFFERENCES as CLASSES
from plots.pictures.palette import OUTCOMES, Palette

# Colour of the interior in the picture of the exits, translucent for light and dark pages.
_INTERIOR = "#7aa7d618"


def _basin_legend(shown: ShownMap) -> Legend:
    ends = shown.palette.legend_entries(shown.spec.outcomes)
    return Legend([*ends.values()], [*shown.outcome_entries().values()], is_short=True)


def _other_legend(shown: ShownMap) -> Legend:
    """Return the outcomes of the other view, and its title."""
    if shown.other is None:
        return Legend(sentence="…")
    ends = shown.palette.legend_entries(shown.other.outcomes)
    return Legend([*ends.values()], [*shown.outcome_entries(shown.other).values()], is_short=True, sentence=shown.other.title)


def _difference_legend(shown: ShownMap) -> Legend:
    """Return the classes of pixels, or the reason why the views cannot be compared."""
    if shown.other is not None and shown.other.axes != shown.spec.plane.axis_symbols:
        return Legend(sentence="Other axes: pixels cannot be compared.")
    return Legend(CLASSES)


def _region_colours(palette: Palette) -> list[str]:
    """Return the colours of the picture of the exits, where the interior has a single colour."""
    starts_without_orbit = (Fate.OUTSIDE, Fate.FORBIDDEN)
    plain = [palette.outcomes[fate].colour if fate in starts_without_orbit else _INTERIOR for fate in OUTCOMES]
    return [*plain, *[_INTERIOR] * len(palette.ends)]


def _background_colours(palette: Palette) -> list[str]:
    """Return the colours below the image of escape times, which covers the pixels of escaping orbits."""
    return [*palette.outcome_colours, *[palette.outcomes[Fate.FORBIDDEN].colour] * len(palette.ends)]


def _crossing_colours(palette: Palette) -> list[str]:
    """Return the colours of the crossings. Bounded pixels have a code for each kind of evidence."""
    return [*palette.outcome_colours, *palette.classes, *[palette.bounded] * len(Evidence)]


CURVES = Picture(
    name="curves",
    title="Zero-velocity curve and exits",
    short_title="Well",
    help="",
    column="fate",
    colours=_region_colours,
    legend=lambda shown: Legend(others=[*shown.outcome_entries().values()]),
)

BASINS = Picture(
    name="basins",
    title="Basins of escape",
    short_title="Basins",
    help=(
        "Each pixel is a start, and its colour shows the exit channel through which its orbit escapes, the body with which "
        "it collides, or that it escapes beyond a radius. Inside a large "
        "region of one colour all neighbours escape through the same exit. Elsewhere the colours are mixed on every "
        "scale: however close two starts are, they may escape through different exits. Bounded orbits have not escaped by "
        "t_max; many of them never will; dots are passages of the chosen orbits through the plane."
    ),
    column="fate",
    colours=lambda palette: palette.fate_colours,
    legend=_basin_legend,
)

TIMES = Picture(
    name="times",
    title="Escape time",
    short_title="Times",
    help=(
        "The escape time is the time at which an orbit crosses a Lyapunov orbit outward. It is short and smooth inside "
        "the basins and diverges at their fractal boundaries. It is also long near islands of bounded orbits, because "
        "orbits stick to the edge of an island before they escape. The colour scale is logarithmic; the colours at its ends "
        "stand for all shorter and all longer times."
    ),
    column="fate",
    colours=_background_colours,
    legend=lambda shown: Legend(others=[*shown.outcome_entries().values()], scale=shown.time_scale()),
    has_times=True,
)

CROSSINGS = Picture(
    name="crossings",
    title="Crossings of the section",
    short_title="Crossings",
    title_of=lambda spec: spec.section.words.title,
    help=(
        "The number of times an orbit crosses the surface of section, y = 0 upward if no other is chosen, before it escapes; the "
        "start does not count. An escape "
        "without a crossing is direct. There is about one crossing per period of the well, so the bands follow the "
        "escape time, and they become thinner towards a basin boundary."
    ),
    column="crossing_class",
    colours=_crossing_colours,
    legend=lambda shown: Legend(shown.palette.crossing_entries, [*shown.outcome_entries().values()]),
)

COMPARED = Picture(
    name="compared",
    title="The other view",
    short_title="Other",
    help=(
        "The basins of the view with which this one is compared: another energy, system or plane, with the same window, "
        "resolution and t_max. All pictures share zoom and cursor. A click marks the same place in both views and chooses "
        "the orbit of the view in the controls."
    ),
    column="fate",
    colours=lambda palette: palette.fate_colours,
    legend=_other_legend,
    compares=True,
)

DIFFERENCES = Picture(
    name="differences",
    title="Where they differ",
    short_title="Differ",
    help=(
        "Starts whose orbits have different outcomes in the two views: different exits, or bounded in one view only. Exits "
        "are compared by their numbers. Close to a basin boundary any change moves starts across it, so small changes of "
        "the energy show where the boundaries are."
    ),
    column="difference",
    colours=lambda palette: [*palette.outcome_colours, *(entry.colour for entry in CLASSES)],
    legend=_difference_legend,
    compares=True,
)
