"""The layer that marks, over other pictures, pixels whose outcome depends on rounding."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap, MapSpec, Trust, compute_trust
from engine.jobs.job import Job
from engine.maps.map_jobs import map_job
from engine.results import TrustMap
from plots.layers.layer import Code, Layer, Over, Pixels, occurring_entries
from plots.pictures.palette import CLEAR, Entry, Mark, Palette
from plots.pictures.setting import Settings

TONES = ("#000000", "#ffffff")
"""Two colours of doubtful pixels. They alternate as on a chessboard, and at least one is visible on any colour."""

CODES = (
    Code(Trust.NOT_APPLICABLE, str(Trust.NOT_APPLICABLE), "", ("#ffffff",)),
    Code(Trust.LIKE_NEIGHBOURS, str(Trust.LIKE_NEIGHBOURS), "not tested: like all its neighbours", ("#dfe6ee",)),
    Code(Trust.CONFIRMED, str(Trust.CONFIRMED), "confirmed: unchanged when computed again", ("#7da7c9",)),
    Code(Trust.DOUBTFUL, str(Trust.DOUBTFUL), "doubtful: depends on rounding", TONES),
    Code(Trust.NOT_TESTED, str(Trust.NOT_TESTED), "trust: not tested yet", ("#b0b0b0",)),
)
"""All codes in order, with the colours of a result that is drawn alone."""

# Code of every second doubtful pixel.
_LIGHT = len(CODES)


def _job(spec: MapSpec, settings: Settings) -> Job[TrustMap]:
    return Job(compute_trust, (map_job(spec),))


def _codes(trust: TrustMap, frame: EscapeMap | None) -> np.ndarray:
    """Return the codes of `Trust`, with `_LIGHT` for every second doubtful pixel."""
    rows, columns = np.indices(trust.trust.shape)
    is_light = (trust.trust == Trust.DOUBTFUL) & ((rows + columns) % 2 == 1)
    return np.where(is_light, _LIGHT, trust.trust).astype(np.uint8)


def _colours(palette: Palette) -> list[str]:
    # The last colour is for `_LIGHT`.
    colours = [code.colours[0] for code in CODES]
    return [*colours, colours[Trust.DOUBTFUL]]


def _marks() -> list[str]:
    """Return the colours over other pictures, where only doubtful pixels are marked."""
    colours = [CLEAR] * (_LIGHT + 1)
    colours[Trust.DOUBTFUL], colours[_LIGHT] = TONES
    return colours


def _sentences() -> list[str]:
    sentences = [code.sentence for code in CODES]
    return [*sentences, sentences[Trust.DOUBTFUL]]


TRUST = Layer(
    name="trust",
    title="Pixels to trust",
    help="Find and mark doubtful pixels, whose fate depends on rounding.",
    stage="doubtful pixels",
    result=TrustMap,
    job=_job,
    pixels=Pixels(
        column="trust",
        codes=_codes,
        colours=_colours,
        entries=lambda trust, palette: occurring_entries(CODES, trust.trust, palette),
        sentences=_sentences(),
    ),
    over=Over(
        pictures=("basins", "crossings"),
        legend=lambda trust, palette: [Entry("doubtful pixels", TONES[0], Mark.CHESSBOARD, TONES[1])],
        pixel_colours=_marks(),
    ),
    variables=("trust",),
    is_offered=lambda frame: frame.is_rounded,
)
"""Pixels whose outcome depends on rounding."""
