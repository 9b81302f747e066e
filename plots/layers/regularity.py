"""The layer of regular and chaotic bounded orbits, with its own picture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine import EscapeMap, Evidence, Fate, MapSpec, Regularity, compute_regularity
from engine.jobs.job import Job
from engine.maps.map_jobs import map_job
from engine.results import RegularityMap
from plots.layers.layer import Code, Layer, Pixels, occurring_entries
from plots.layers.picture import Legend, Picture, ShownMap
from plots.pictures.image_columns import FIRST_CLASS, pixel_codes
from plots.pictures.palette import COLOUR_BLIND_SAFE, PAPER, Entry, Palette
from plots.pictures.setting import Settings

# Each code has a colour as in the paper, and a colour-blind safe colour.
CODES = (
    Code(Regularity.NOT_APPLICABLE, "escapes", "", ("#f4ead2", "#f3efe2")),
    Code(Regularity.REGULAR, "bounded and regular", "regular", ("#40e8e6", "#87e9f1")),
    Code(Regularity.CHAOTIC, "bounded and chaotic", "chaotic", ("#d81fa4", "#ff234a")),
    Code(
        Regularity.NO_SIGN_OF_CHAOS,
        "bounded, no sign of chaos until t_max",
        "no sign of chaos until t_max",
        ("#a0c0b0", "#20c0d8"),
    ),
    Code(
        Regularity.NOT_JUDGED,
        "bounded, not judged yet",
        "regular or chaotic: not known yet",
        (PAPER.bounded, COLOUR_BLIND_SAFE.bounded),
    ),
    Code(
        Regularity.UNDECIDED,
        "bounded, undecided whether regular or chaotic",
        "undecided whether regular or chaotic",
        ("#e8e810", "#8858e8"),
    ),
)
"""All codes in order."""


def entries(palette: Palette) -> list[Entry]:
    """Return the legend entries of all codes, in order."""
    return [code.entry(palette) for code in CODES]


def _colours(palette: Palette) -> list[str]:
    return [*palette.outcome_colours, *(entry.colour for entry in entries(palette))]


def _job(spec: MapSpec, settings: Settings) -> Job[RegularityMap]:
    return Job(compute_regularity, (map_job(spec),))


def _refusal(spec: MapSpec) -> str:
    has_gaps = bool(spec.potential.gaps)
    return "Near a body, SALI falls and rises again, so it does not tell regular from chaotic orbits." if has_gaps else ""


def _codes(regularity: RegularityMap, frame: EscapeMap | None) -> np.ndarray:
    fate = np.full(regularity.character.shape, Fate.BOUNDED) if frame is None else frame.fate
    return pixel_codes(fate, regularity.character, bounded_too=True)


def _codes_by_evidence(images: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the codes from the evidence of the map: orbits on an invariant torus are regular."""
    character = np.where(images["fate"] == Fate.BOUNDED, Regularity.NOT_JUDGED, Regularity.NOT_APPLICABLE)
    character[images["evidence"] == Evidence.QUASI_PERIODIC] = Regularity.REGULAR
    return pixel_codes(images["fate"], character, bounded_too=True)


def _legend(shown: ShownMap) -> Legend:
    # In the order of `CODES`.
    escapes, *judged, unjudged, undecided = entries(shown.palette)
    result = shown.results.get("judge")
    pending = [] if result is not None and result.complete else [unjudged]
    if result is not None and np.any(result.character == Regularity.UNDECIDED):
        pending.append(undecided)
    others = [entry for fate, entry in shown.outcome_entries().items() if fate is not Fate.BOUNDED]
    return Legend([*judged, *pending], [escapes, *others])


REGULARITY = Layer(
    name="judge",
    title="Regular or chaotic",
    help="Classify bounded orbits as regular or chaotic.",
    stage="bounded orbits",
    result=RegularityMap,
    job=_job,
    refusal=_refusal,
    pixels=Pixels(
        column="character",
        codes=_codes,
        colours=_colours,
        entries=lambda regularity, palette: occurring_entries(CODES, regularity.character, palette),
        sentences=[""] * FIRST_CLASS + [code.sentence for code in CODES],
        first_codes=_codes_by_evidence,
    ),
    picture=Picture(
        name="characters",
        title="Regular or chaotic",
        short_title="Chaos",
        help=(
            "A bounded orbit is regular if averages over it agree as on a torus, and chaotic if SALI falls by t_max; "
            "otherwise it shows no sign of chaos until t_max. Regular orbits form islands, which no orbit enters or leaves. A "
            "chaotic orbit that has not escaped is usually sticky: it stays near the edge of an island and may escape long "
            "after t_max. Escaping orbits are not classified."
        ),
        column="character",
        colours=_colours,
        legend=_legend,
    ),
    variables=("character",),
    is_empty=lambda frame: not np.any(frame.fate == Fate.BOUNDED),
)
"""The character of bounded orbits: regular or chaotic."""
