"""A complete map in the form that measures take, and the measurement of one value of a sweep."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.maps.analyses.regularity import compute_regularity
from engine.maps.pixels import MirrorPixels
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.basins.escape_statistics import EscapeStatistics, compute_statistics
from engine.measures.basins.starts import Starts, read_starts
from engine.propagation.fates import Fate
from engine.slices.window import Window
from engine.systems.outcomes import Outcome

MAX_JUDGED_STARTS = 2000
"""Largest number of bounded starts, drawn at random, that are judged. They give a share to about ± 2 % (95 % interval)."""


@dataclass(frozen=True, eq=False)
class MeasuredMap:
    """A complete map, or a box in it, with quantities that several measures need.

    Attributes
    ----------
    escape_map
        The map.
    box
        Window of the starts that count; None for all starts.
    execution
        How additional orbits are computed.
    effort
        Number of additional orbits as a share of the usual number; a tenth makes intervals about three times as wide.
    """

    escape_map: EscapeMap
    box: Window | None = None
    execution: Execution = DEFAULT_EXECUTION
    effort: float = 1.0

    @property
    def spec(self) -> MapSpec:
        """The request of the map."""
        return self.escape_map.spec

    @cached_property
    def starts(self) -> Starts:
        """The starts that count."""
        starts = read_starts("escape_map", self.escape_map)
        return starts if self.box is None else starts.inside(self.box)

    @cached_property
    def statistics(self) -> EscapeStatistics:
        """Counts of the interior starts."""
        return compute_statistics(self.starts)

    def find_characters(self) -> np.ndarray:
        """Return the `Regularity` codes of bounded starts that count, (n,), from new orbits.

        If there are more of these starts than `effort` allows, some are drawn at random, except along a parameter.
        """
        index = np.s_[:, :] if self.box is None else read_starts("escape_map", self.escape_map).pixel_slices(self.box)
        is_bounded = np.zeros(self.escape_map.fate.shape, bool)
        is_bounded[index] = self.starts.fate == Fate.BOUNDED
        pixels = np.flatnonzero(is_bounded)
        most_pixels = round(self.effort * MAX_JUDGED_STARTS)
        # Along a parameter all starts are judged, because each line of pixels has its own mirror images.
        if pixels.size > most_pixels and self.spec.plane.parameter is None:
            pixels = np.random.default_rng(0).choice(pixels, most_pixels, replace=False)
        regularity = compute_regularity(self._restricted_map(pixels), execution=self.execution)
        self.execution.raise_if_cancelled()
        return regularity.character.ravel()[pixels]

    def _restricted_map(self, pixels: np.ndarray) -> EscapeMap:
        """Return the map with the fates of n pixels and of their mirror images; all other starts are outside."""
        escape_map = self.escape_map
        is_kept = np.zeros(escape_map.fate.size, bool)
        is_kept[pixels] = True
        is_kept[MirrorPixels(escape_map.spec, escape_map.x, escape_map.ordinate).partner[pixels]] = True
        return replace(escape_map, fate=np.where(is_kept.reshape(escape_map.fate.shape), escape_map.fate, Fate.OUTSIDE))


@dataclass(frozen=True)
class SweepPoint:
    """The request for the measurement at one value of a sweep.

    Attributes
    ----------
    map_spec
        The map to measure.
    place
        The name of each axis of the sweep, such as "h" or "epsilon", and the value on this axis.
    measures
        Names of `MEASURES`.
    numbers
        The fate in the sweep for each fate 0, 1, … of the map, see `Member.numbers`.
    outcomes
        The outcomes of the sweep.
    """

    map_spec: MapSpec
    place: tuple[tuple[str, float], ...]
    measures: tuple[str, ...]
    numbers: tuple[int, ...]
    outcomes: tuple[Outcome, ...]
