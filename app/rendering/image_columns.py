"""From a map to the columns of the one data source that all four pictures share."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.rendering.palette import CROSSING_CLASSES, MOST_CHANNELS, OUTCOMES
from engine import Certificate, EscapeMap, Fate, OriginFateMap, Regularity, RegularityMap

_OUTCOME_CODES = {fate: code for code, fate in enumerate(OUTCOMES)}
_FIRST_CLASS = len(OUTCOMES)
_LEAST_CROSSINGS = np.array([least for least, _ in CROSSING_CLASSES])


def map_columns(frame: EscapeMap, *, characters: bool = True) -> dict[str, list[Any]]:
    """One image a column, in the smallest types that hold it, and the place of the images in the plane.

    A coarse frame has coarse images. Without `characters` that column is a single pixel: nobody looks at it. So is the column of
    passages, which a map does not know by itself.
    """
    images, window = frame.thinned()
    fate, crossings = images["fate"], images["crossings"]
    classes = np.searchsorted(_LEAST_CROSSINGS, crossings, side="right") - 1
    # A bounded pixel has its certificate instead.
    classes[fate == Fate.BOUNDED] = len(CROSSING_CLASSES) + images["certificate"][fate == Fate.BOUNDED]
    character = _codes(fate, _known_from_certificates(images), bounded_too=True) if characters else np.zeros((1, 1), np.uint8)
    return {
        "fate": [_codes(fate, fate - 1)],
        "crossing_class": [_codes(fate, classes, bounded_too=True)],
        "crossings": [crossings.astype(np.min_scalar_type(crossings.max(initial=0)))],
        "escape_time": [images["escape_time"].astype(np.float32)],
        "character": [character],
        "passage": [np.zeros((1, 1), np.uint8)],
        "x": [window.x_low],
        "y": [window.ordinate_low],
        "dw": [window.x_high - window.x_low],
        "dh": [window.ordinate_high - window.ordinate_low],
        "complete": [frame.complete],
    }


def character_column(frame: EscapeMap, regularity: RegularityMap) -> dict[str, list[Any]]:
    """The one column that the judging of bounded orbits changes."""
    return {"character": [_codes(frame.fate, regularity.character, bounded_too=True)]}


def passage_column(origins: OriginFateMap) -> dict[str, list[Any]]:
    """The one column that tells both where orbits come from and where they go."""
    passage = origins.origin.astype(np.int64) * (MOST_CHANNELS + 1) + origins.fate
    # Where one of both is no end but an outcome, so is the pixel.
    outcome = np.minimum(origins.origin, origins.fate)
    return {"passage": [_codes(outcome, passage, bounded_too=True)]}


def _known_from_certificates(images: dict[str, np.ndarray]) -> np.ndarray:
    """What a map says by itself: on a torus an orbit is regular."""
    known = np.where(images["fate"] == Fate.BOUNDED, Regularity.NOT_JUDGED, Regularity.NO_QUESTION)
    known[images["certificate"] == Certificate.QUASI_PERIODIC] = Regularity.REGULAR
    return known


def _codes(fate: np.ndarray, classes: np.ndarray, *, bounded_too: bool = False) -> np.ndarray:
    """Pixel codes: outcomes by their place in the palette, escaped pixels, or bounded ones too, by their class after those."""
    codes = (_FIRST_CLASS + classes).astype(np.uint8)
    for outcome, code in _OUTCOME_CODES.items():
        if not (bounded_too and outcome is Fate.BOUNDED):
            codes[fate == outcome] = code
    return codes


def longest_typical_time(frame: EscapeMap) -> float:
    """The escape time that all but the slowest hundredth of the escaped pixels stay below, rounded up to 1, 2 or 5 · 10^k."""
    times = frame.escape_time[frame.fate > Fate.BOUNDED]
    if times.size == 0:
        return 100.0
    high = max(float(np.quantile(times, 0.99)), 10.0)
    power = 10.0 ** np.floor(np.log10(high))
    return float(power * next(step for step in (1.0, 2.0, 5.0, 10.0) if step * power >= high))
