"""The layer of origins. Its picture shows the exits by which each orbit entered and leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from engine import EscapeMap, MapSpec, Outcome
from engine.jobs.job import Job
from engine.maps.map_jobs import map_job
from engine.maps.origin_fates import join_origin_fates
from engine.results import OriginFateMap
from plots.layers.layer import Layer, Pixels
from plots.layers.picture import ColourTable, Legend, Picture, ShownMap
from plots.pictures.image_columns import FIRST_CLASS, at_places, end_numbers, pixel_codes
from plots.pictures.palette import PAPER, Entry, Palette, end_places, mixed, short_label
from plots.pictures.setting import Settings

# For each origin from 1 to 13, the share of white (if positive) or black (if negative) mixed into the colour of the exit.
_TONES = (0.6, 0.0, -0.4, -0.65, 0.35, -0.2, 0.78, -0.8, 0.48, -0.52, 0.2, -0.3, 0.7)
# Share of the colour of bounded orbits in the colour of orbits that never entered.
_BOUNDED_SHARE = 0.65


def _count_ends() -> int:
    """Return the number of origins: one for each end, and one for orbits that never entered."""
    return len(PAPER.ends) + 1


def passage_colour(palette: Palette, origin: int, fate: int) -> str:
    """Return the colour of an origin and a fate, numbered from 1; 0 means never entered, or bounded. The fate sets the hue."""
    colour = palette.ends[fate - 1] if fate else palette.bounded
    if origin == 0:
        return mixed(colour, palette.bounded, _BOUNDED_SHARE)
    tone = _TONES[(origin - 1) % len(_TONES)]
    return mixed(colour, "#ffffff" if tone > 0 else "#000000", abs(tone))


def _colours(palette: Palette) -> list[str]:
    """Return the colours of fates that are not ends, followed by the colours by origin and fate, both from 0."""
    passages = (passage_colour(palette, origin, fate) for origin in range(_count_ends()) for fate in range(_count_ends()))
    return [*palette.outcome_colours, *passages]


def _sentences(origins: OriginFateMap) -> list[str]:
    outcomes = origins.spec.outcomes
    words = ["never entered: inside since −t_max", *at_places(outcomes, [end.origin for end in outcomes])]
    return [""] * FIRST_CLASS + [word for word in words for _ in range(_count_ends())]


def _job(spec: MapSpec, settings: Settings) -> Job[OriginFateMap]:
    return Job(join_origin_fates, tuple(map_job(replace(spec, backward=backward)) for backward in (False, True)))


def _refusal(spec: MapSpec) -> str:
    return "The origins of orbits are shown on maps forward in time only." if spec.backward else ""


def _codes(origins: OriginFateMap, frame: EscapeMap | None) -> np.ndarray:
    origin, fate = (end_numbers(codes, origins.spec.outcomes) for codes in (origins.origin, origins.fate))
    # Fates that are neither ends nor bounded are negative. If the origin or the fate is one of them, it colours the pixel.
    outcome = np.minimum(origins.origin, origins.fate)
    return pixel_codes(outcome, origin * _count_ends() + fate, bounded_too=True)


def _legend(shown: ShownMap) -> Legend:
    palette, outcomes = shown.palette, shown.spec.outcomes
    return Legend(_entries(palette, outcomes), [*shown.outcome_entries().values()], table=_table(palette, outcomes))


def _entries(palette: Palette, outcomes: Sequence[Outcome]) -> list[Entry]:
    """Return the legend as a list."""
    places = zip(end_places(outcomes), outcomes, strict=True)
    labels = {0: "inside"} | {place + 1: short_label(end.label) for place, end in places if end.occurs}
    pairs = ((origin, fate) for origin in labels for fate in labels if fate)
    return [Entry(f"{labels[origin]} to {labels[fate]}", passage_colour(palette, origin, fate)) for origin, fate in pairs]


def _table(palette: Palette, outcomes: Sequence[Outcome]) -> ColourTable:
    """Return the legend as a table: for each fate, the origins."""
    names = {place + 1: short_label(end.label) for place, end in zip(end_places(outcomes), outcomes, strict=True)}
    names |= {0: "bounded"}
    tones = [[passage_colour(palette, origin, fate) for origin in names] for fate in names]
    return ColourTable(tuple(names.values()), tones)


ORIGINS = Layer(
    name="origins",
    title="Origin and exit",
    help="Find the exit through which each orbit came in.",
    stage="origins",
    result=OriginFateMap,
    job=_job,
    refusal=_refusal,
    pixels=Pixels(
        column="passage",
        codes=_codes,
        colours=_colours,
        entries=lambda origins, palette: _entries(palette, origins.spec.outcomes),
        own_sentences=_sentences,
    ),
    picture=Picture(
        name="origins",
        title="Origin and exit",
        short_title="Origins",
        help=(
            "Each orbit is integrated in both directions of time. The hue shows the exit through which it escapes, as in the "
            "basins; the tone shows the exit through which it came in. The exit changes across the stable manifolds of the "
            "Lyapunov orbits, the origin across the unstable ones. Where both kinds of curves accumulate lies the chaotic "
            "saddle, the set of orbits that stay for ever."
        ),
        column="passage",
        colours=_colours,
        legend=_legend,
    ),
    variables=("origin",),
)
"""The exits by which orbits enter and leave."""
