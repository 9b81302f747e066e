"""Make the columns of the Bokeh data source that all pictures of a map share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from engine import EscapeMap, Fate, Outcome, Section
from plots.pictures.palette import CROSSING_CLASSES, OUTCOMES, PAPER, end_places

NO_LAYER = [np.zeros((1, 1), np.uint8)]
"""Column of a layer that is off."""

# Pixel codes by fate, of fates that are not ends.
_OUTCOME_CODES = {fate: code for code, fate in enumerate(OUTCOMES)}
FIRST_CLASS = len(OUTCOMES)
"""The first pixel code of a class. Lower codes are for fates that are not ends."""

# Pixel code of orbits that are not computed.
_UNDECIDED = _OUTCOME_CODES[Fate.NOT_COMPUTED]
# Pixel codes of starts without an orbit.
_WITHOUT_ORBIT = (_OUTCOME_CODES[Fate.OUTSIDE], _OUTCOME_CODES[Fate.FORBIDDEN])
# Fewest crossings of each crossing class.
_LEAST_CROSSINGS = np.array([least for least, _ in CROSSING_CLASSES])

PIXEL_COLUMNS = ("fate", "crossing_class", "crossings", "escape_time")
"""The images of a map by itself."""


def map_columns(frame: EscapeMap) -> dict[str, list[Any]]:
    """Return the columns of a map: images in the smallest integer types, and their position in the plane.

    Coarse frames have coarse images. The column of differences is one pixel, because it needs another map (`difference_column`).
    """
    images, window = frame.thinned()
    fate, crossings = images["fate"], images["crossings"]
    classes = np.searchsorted(_LEAST_CROSSINGS, crossings, side="right") - 1
    # Bounded pixels are classified by their evidence.
    classes[fate == Fate.BOUNDED] = len(CROSSING_CLASSES) + images["evidence"][fate == Fate.BOUNDED]
    return {
        "fate": [fate_codes(fate, frame.spec.outcomes)],
        "crossing_class": [pixel_codes(fate, classes, bounded_too=True)],
        "crossings": [crossings.astype(np.min_scalar_type(crossings.max(initial=0)))],
        "escape_time": [images["escape_time"].astype(np.float32)],
        "difference": NO_LAYER,
        "ends": [end_words(frame.spec.outcomes)],
        "crossing_words": [crossing_words(frame.spec.section)],
        "x": [window.x_low],
        "y": [window.ordinate_low],
        "dw": [window.width],
        "dh": [window.height],
        "energy": [np.nan if frame.spec.common_energy is None else frame.spec.common_energy],
        "complete": [frame.complete],
    }


def fate_codes(fate: np.ndarray, outcomes: Sequence[Outcome]) -> np.ndarray:
    """Return the uint8 codes of the picture of the basins for fates of any shape."""
    return pixel_codes(fate, end_numbers(fate, outcomes) - 1)


def draw_over(columns: dict[str, list[Any]], earlier: dict[str, list[Any]], sides: tuple[int, int]) -> dict[str, list[Any]]:
    """Return the columns of an unfinished frame over an earlier map, whose pixels stay until finer pixels are computed.

    Parameters
    ----------
    columns, earlier
        Columns of `map_columns`. The windows may differ.
    sides
        (columns, rows) of the finished map, the largest size of the images. The pixels are as fine as the finer of both maps.
    """
    if columns["complete"][0]:
        return columns
    pixels, earlier_pixels = _pixel_sides(columns), _pixel_sides(earlier)
    is_earlier_finer = earlier_pixels[0] < pixels[0]
    window_sides = columns["dw"][0], columns["dh"][0]
    finer_pixels = earlier_pixels if is_earlier_finer else pixels
    column_count, row_count = (
        min(max(round(length / pixel), 1), side) for length, pixel, side in zip(window_sides, finer_pixels, sides, strict=True)
    )
    x = columns["x"][0] + columns["dw"][0] * (np.arange(column_count) + 0.5) / column_count
    y = columns["y"][0] + columns["dh"][0] * (np.arange(row_count) + 0.5) / row_count
    index, _ = _pixels_at(columns, x, y)
    earlier_index, is_inside = _pixels_at(earlier, x, y)
    is_decided = is_inside & (earlier["fate"][0][earlier_index] != _UNDECIDED)
    is_kept = is_decided & (is_earlier_finer | (columns["fate"][0][index] == _UNDECIDED))
    images = {name: [np.where(is_kept, earlier[name][0][earlier_index], columns[name][0][index])] for name in PIXEL_COLUMNS}
    return columns | images


def _pixel_sides(columns: dict[str, list[Any]]) -> tuple[float, float]:
    """Return the width and height of the pixels of a map's columns."""
    row_count, column_count = columns["fate"][0].shape
    return columns["dw"][0] / column_count, columns["dh"][0] / row_count


def _pixels_at(columns: dict[str, list[Any]], x: np.ndarray, y: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Return row and column indices of the pixels at x (columns,) and y (rows,), and whether these points lie in the images."""
    row_count, column_count = columns["fate"][0].shape
    column = np.floor((x - columns["x"][0]) / columns["dw"][0] * column_count).astype(int)
    row = np.floor((y - columns["y"][0]) / columns["dh"][0] * row_count).astype(int)
    is_inside = ((row >= 0) & (row < row_count))[:, None] & ((column >= 0) & (column < column_count))
    return np.ix_(row.clip(0, row_count - 1), column.clip(0, column_count - 1)), is_inside


def difference_column(columns: dict[str, list[Any]], other: dict[str, list[Any]]) -> dict[str, list[Any]]:
    """Return the column ``difference``: whether orbits have another outcome in another view of a plane with the same axes.

    Parameters
    ----------
    columns
        Columns of `map_columns`.
    other
        Columns of the other view. Window and number of pixels may differ.
    """
    row_count, column_count = columns["fate"][0].shape
    width, height = _pixel_sides(columns)
    x = columns["x"][0] + width * (np.arange(column_count) + 0.5)
    y = columns["y"][0] + height * (np.arange(row_count) + 0.5)
    other_index, is_inside = _pixels_at(other, x, y)
    other_codes = np.where(is_inside, other["fate"][0][other_index], _UNDECIDED)
    return {"difference": [_difference_codes(columns["fate"][0], other_codes)]}


def _difference_codes(codes: np.ndarray, other_codes: np.ndarray) -> np.ndarray:
    """Return codes of `DIFFERENCES` for pixel codes of fates in two views. Pixels without an orbit in either view keep theirs."""
    lacks_orbit = np.isin(codes, _WITHOUT_ORBIT)
    lacks_other_orbit = np.isin(other_codes, _WITHOUT_ORBIT)
    # Indices of `DIFFERENCES`.
    classes = np.where(lacks_orbit != lacks_other_orbit, 2, np.where(codes != other_codes, 1, 0))
    difference_codes = np.where(lacks_orbit & lacks_other_orbit, codes, FIRST_CLASS + classes)
    return np.where((codes == _UNDECIDED) | (other_codes == _UNDECIDED), _UNDECIDED, difference_codes).astype(np.uint8)


def end_words(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the words for an orbit at each of `Palette.ends`; empty words for ends that the potential does not have."""
    return at_places(outcomes, [outcome.present for outcome in outcomes])


def crossing_words(section: Section) -> list[str]:
    """Return the words for one crossing of a section, and for several: "upward crossing of y = 0"."""
    words = section.words
    return [f"{words.singular}{words.place}", f"{words.plural}{words.place}"]


def at_places(outcomes: Sequence[Outcome], words: Sequence[str]) -> list[str]:
    """Return a list with the word of each outcome at its place among `Palette.ends`, and empty words elsewhere."""
    words_by_place = [""] * len(PAPER.ends)
    for place, word in zip(end_places(outcomes), words, strict=True):
        words_by_place[place] = word
    return words_by_place


def pixel_coding(outcomes: Sequence[Outcome], section: Section = Section.Y_UP) -> dict[str, Any]:
    """Return the tables with which the browser turns pixels of a potential with these outcomes into codes.

    The result contains the fates that are not ends, the first class, the places and words of the ends, the classes and words of
    crossings, the code of pixels that are not decided, and for each code the codes of differences from all codes.
    """
    codes = np.arange(FIRST_CLASS + len(PAPER.ends), dtype=np.uint8)
    return {
        "outcomes": [[int(fate), code] for fate, code in _OUTCOME_CODES.items()],
        "firstClass": FIRST_CLASS,
        "ends": end_places(outcomes),
        "words": end_words(outcomes),
        "leastCrossings": _LEAST_CROSSINGS.tolist(),
        "crossingWords": crossing_words(section),
        "undecided": _UNDECIDED,
        "differences": _difference_codes(codes[:, None], codes).tolist(),
    }


def end_numbers(fate: np.ndarray, outcomes: Sequence[Outcome]) -> np.ndarray:
    """Return the number of the end of each fate, 1 for the first of `Palette.ends`; 0 for fates that are not ends."""
    numbers = np.array([0, *(place + 1 for place in end_places(outcomes))])
    return numbers[np.maximum(fate, 0)]


def pixel_codes(fate: np.ndarray, classes: np.ndarray, *, bounded_too: bool = False) -> np.ndarray:
    """Return codes of fates that are not ends, and of classes elsewhere. With `bounded_too`, bounded pixels also have classes."""
    codes = (FIRST_CLASS + classes).astype(np.min_scalar_type(FIRST_CLASS + int(classes.max(initial=0))))
    for outcome, code in _OUTCOME_CODES.items():
        if not (bounded_too and outcome is Fate.BOUNDED):
            codes[fate == outcome] = code
    return codes
