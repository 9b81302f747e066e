"""The scale of a layer with continuous values: classes of equal width, their colours, and the legend."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine import EscapeMap, Fate
from plots.layers.picture import ColourScale, Legend, ShownMap
from plots.pictures.image_columns import FIRST_CLASS, pixel_codes
from plots.pictures.palette import Entry, Palette, value_colours

# Number of classes of equal width. Their codes and the codes of other pixels fit into uint8.
_CLASSES = 240
# Share of the values below the scale, and equal share above the scale. They are drawn in the colours of its ends.
_CLIPPED_SHARE = 0.01


@dataclass(frozen=True)
class ValueScale[Found]:
    """The colours of the values of a result. Its methods are those that `Pixels` and `Picture` need.

    Attributes
    ----------
    values
        Returns the values of a result, of shape (rows, columns); NaN for pixels without a value.
    """

    values: Callable[[Found], np.ndarray]

    @property
    def no_sentences(self) -> list[str]:
        """An empty description for each code: the hover text shows the value itself."""
        return [""] * (FIRST_CLASS + _CLASSES)

    def colours(self, palette: Palette) -> list[str]:
        """Return the colours of the codes."""
        return [*palette.outcome_colours, *value_colours(_CLASSES)]

    def limits(self, result: Found) -> tuple[float, float]:
        """Return the ends of the scale. Few pixels have values beyond the ends."""
        values = self.values(result)
        values = values[np.isfinite(values)]
        if not values.size:
            return 0.0, 1.0
        low, high = np.quantile(values, (_CLIPPED_SHARE, 1.0 - _CLIPPED_SHARE)).tolist()
        return (low, high) if low < high else (low, low + 1.0)

    def codes(self, result: Found, frame: EscapeMap | None) -> np.ndarray:
        """Return the codes of the pixels. Pixels without a value have the code of their fate, if it needs no orbit."""
        low, high = self.limits(result)
        values = self.values(result)
        is_known = np.isfinite(values)
        share = (np.clip(np.where(is_known, values, low), low, high) - low) / (high - low)
        fate = np.full(values.shape, Fate.NOT_COMPUTED) if frame is None else frame.fate
        fate_without_value = np.where((fate == Fate.FORBIDDEN) | (fate == Fate.OUTSIDE), fate, Fate.NOT_COMPUTED)
        classes = np.minimum((share * _CLASSES).astype(int), _CLASSES - 1)
        # `pixel_codes` keeps the classes of bounded pixels, so all pixels with a value are passed as bounded.
        return pixel_codes(np.where(is_known, Fate.BOUNDED, fate_without_value), classes, bounded_too=True)

    def legend(self, shown: ShownMap, result: Found | None) -> Legend:
        """Return the legend of a map with a result; "…" until there is one."""
        if result is None:
            return Legend(sentence="…")
        fates_without_orbit = {Fate.FORBIDDEN, Fate.OUTSIDE}
        others: list[Entry] = [entry for fate, entry in shown.outcome_entries().items() if fate in fates_without_orbit]
        low, high = (float(f"{end:.3g}") for end in self.limits(result))
        return Legend(others=others, scale=ColourScale(low, high, value_colours(_CLASSES), is_logarithmic=False))
