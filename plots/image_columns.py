"""Columns of the Bokeh data source that all pictures of a map share."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine import Certificate, EscapeMap, Fate, OriginFateMap, Regularity, RegularityMap, Trust, TrustMap
from plots.palette import CROSSING_CLASSES, MOST_CHANNELS, OUTCOMES

NO_LAYER = [np.zeros((1, 1), np.uint8)]
"""Column of a layer that is off."""

_OUTCOME_CODES = {fate: code for code, fate in enumerate(OUTCOMES)}
_FIRST_CLASS = len(OUTCOMES)
_LEAST_CROSSINGS = np.array([least for least, _ in CROSSING_CLASSES])


def map_columns(frame: EscapeMap, *, characters: bool = True) -> dict[str, list[Any]]:
    """One image per column, in the smallest integer types, and the position of the images in the plane.

    Coarse frames have coarse images. The column of passages is a single pixel: it needs a follow-up analysis
    (`passage_column`). The column of characters is one too, unless `characters` is true.
    """
    images, window = frame.thinned()
    fate, crossings = images["fate"], images["crossings"]
    classes = np.searchsorted(_LEAST_CROSSINGS, crossings, side="right") - 1
    # Bounded pixels are classified by their certificate.
    classes[fate == Fate.BOUNDED] = len(CROSSING_CLASSES) + images["certificate"][fate == Fate.BOUNDED]
    character = [_codes(fate, _certified_characters(images), bounded_too=True)] if characters else NO_LAYER
    return {
        "fate": [_codes(fate, fate - 1)],
        "crossing_class": [_codes(fate, classes, bounded_too=True)],
        "crossings": [crossings.astype(np.min_scalar_type(crossings.max(initial=0)))],
        "escape_time": [images["escape_time"].astype(np.float32)],
        "character": character,
        "passage": NO_LAYER,
        "x": [window.x_low],
        "y": [window.ordinate_low],
        "dw": [window.x_high - window.x_low],
        "dh": [window.ordinate_high - window.ordinate_low],
        "energy": [np.nan if frame.spec.common_energy is None else frame.spec.common_energy],
        "complete": [frame.complete],
    }


def pixel_coding() -> dict[str, Any]:
    """How pixels become codes, for programs that make the columns elsewhere: outcomes, first class, classes of crossings."""
    return {
        "outcomes": [[int(fate), code] for fate, code in _OUTCOME_CODES.items()],
        "first": _FIRST_CLASS,
        "leastCrossings": _LEAST_CROSSINGS.tolist(),
    }


def character_column(frame: EscapeMap, regularity: RegularityMap) -> dict[str, list[Any]]:
    """Column of regular and chaotic bounded orbits."""
    return {"character": [_codes(frame.fate, regularity.character, bounded_too=True)]}


def passage_column(origins: OriginFateMap) -> dict[str, list[Any]]:
    """Column of origin and fate of each orbit."""
    passage = origins.origin.astype(np.int64) * (MOST_CHANNELS + 1) + origins.fate
    # If the origin or the fate is not a channel, the pixel shows that outcome.
    outcome = np.minimum(origins.origin, origins.fate)
    return {"passage": [_codes(outcome, passage, bounded_too=True)]}


def doubt_tones(trust: TrustMap) -> np.ndarray:
    """(rows, columns) uint8: 1 and 2 alternately on doubtful pixels, as on a chessboard, for the colours `DOUBT`; 0 elsewhere."""
    rows, columns = np.indices(trust.trust.shape)
    tones: np.ndarray = np.where(trust.trust == Trust.DOUBTFUL, 1 + (rows + columns) % 2, 0).astype(np.uint8)
    return tones


def _certified_characters(images: dict[str, np.ndarray]) -> np.ndarray:
    """Regularity as far as certificates tell: orbits on an invariant torus are regular."""
    character = np.where(images["fate"] == Fate.BOUNDED, Regularity.NOT_JUDGED, Regularity.NOT_APPLICABLE)
    character[images["certificate"] == Certificate.QUASI_PERIODIC] = Regularity.REGULAR
    return character


def _codes(fate: np.ndarray, classes: np.ndarray, *, bounded_too: bool = False) -> np.ndarray:
    """Pixel codes: outcomes, then classes of escaped pixels, and of bounded ones if `bounded_too`."""
    codes = (_FIRST_CLASS + classes).astype(np.uint8)
    for outcome, code in _OUTCOME_CODES.items():
        if not (bounded_too and outcome is Fate.BOUNDED):
            codes[fate == outcome] = code
    return codes


def longest_typical_time(frame: EscapeMap) -> float:
    """99th percentile of the escape times, at least 10, rounded up to 1, 2 or 5 · 10^k; 100 if nothing escapes."""
    times = frame.escape_time[frame.fate > Fate.BOUNDED]
    if times.size == 0:
        return 100.0
    high = max(float(np.quantile(times, 0.99)), 10.0)
    power = 10.0 ** np.floor(np.log10(high))
    return float(power * next(step for step in (1.0, 2.0, 5.0, 10.0) if step * power >= high))
