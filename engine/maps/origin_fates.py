"""Origins and fates of orbits: their outcomes backward in time, such as the channel of entry, and forward in time."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_share
from engine.maps.compute import compute_map
from engine.maps.pixels import PixelAnalysis
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.propagation.fates import Fate
from engine.systems.outcomes import Exit

# Verbs for the outcomes of an orbit, by the name of the array.
_VERBS = {"origin": "entered", "fate": "leaves"}


@dataclass(frozen=True, eq=False, repr=False)
class OriginFateMap(PixelAnalysis):
    """The outcomes, backward and forward in time, of the orbit through each pixel.

    Attributes
    ----------
    spec
        The request for the map of fates.
    x, ordinate
        (columns,), (rows,) pixel centres.
    origin, fate
        (rows, columns) int8: the outcome k ≥ 1, such as the channel through which the orbit entered or leaves, or a `Fate`.
        `Fate.BOUNDED` means that the orbit has been inside since −t_max, or stays inside until t_max. Read-only.
    """

    x: np.ndarray
    ordinate: np.ndarray
    origin: np.ndarray
    fate: np.ndarray
    codes: ClassVar = {"origin": Fate, "fate": Fate}

    @property
    def fate_labels(self) -> Sequence[str]:
        """Labels of the outcomes 1, 2, …"""
        return [outcome.label for outcome in self.spec.outcomes]

    def count_passages(self) -> np.ndarray:
        """Return the numbers of starts by origin (row) and fate (column), (outcomes + 1, outcomes + 1). Index 0 is bounded."""
        size = len(self.spec.outcomes) + 1
        is_decided = (self.origin >= 0) & (self.fate >= 0)
        pair_codes = self.origin[is_decided].astype(np.int64) * size + self.fate[is_decided]
        return np.bincount(pair_codes, minlength=size * size).reshape(size, size)

    def describe(self) -> str:
        """Return the shares of orbits that enter and leave, of those that do so alike, and of bounded orbits, in one sentence."""
        counts = self.count_passages()
        total = max(int(counts.sum()), 1)
        has_only_exits = all(outcome.kind is Exit for outcome in self.spec.outcomes)
        verb, manner = (
            ("enter and leave", "through the same exit") if has_only_exits else ("end in both time directions", "alike")
        )
        ended_twice = counts[1:, 1:]
        both, alike, bounded = (format_share(count / total) for count in (ended_twice.sum(), np.trace(ended_twice), counts[0, 0]))
        return (
            f"{both} of the interior starts lie on orbits that {verb}, {alike} {manner}; "
            f"{bounded} are bounded in both time directions, the rest in one."
        )

    def _meaning(self, name: str, values: np.ndarray) -> dict[str, str]:
        return {"long_name": f"channel the orbit {_VERBS[name]} by (k >= 1) or outcome code", **super()._meaning(name, values)}


@checks_types(spec=MapSpec, execution=Execution)
def compute_origin_fates(spec: MapSpec, *, execution: Execution = DEFAULT_EXECUTION) -> OriginFateMap:
    """Follow the orbit through each pixel in both time directions.

    The past of (x, y, px, py) is the future of (x, y, −px, −py), in a rotating frame with −Ω for Ω.

    Parameters
    ----------
    spec
        The request for the map of fates; its `backward` is ignored.
    execution
        How the computation runs.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When no exit is defined at an energy of `spec`.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_origin_fates
    >>> origins = compute_origin_fates(MapSpec(CASES["III"], Plane.X_PX, 0.6, (40, 40), t_max=1e3))
    >>> origins.count_passages()[1:, 1:]
    array([[ 18,  34,   4,  10],
           [ 34,  18,  10,   4],
           [410,  34,  18,  34],
           [ 34, 410,  34,  18]])
    """
    forward, backward = (
        compute_map(replace(spec, backward=is_backward), execution=execution.part(int(is_backward), 2))
        for is_backward in (False, True)
    )
    if not (forward.complete and backward.complete):
        raise CancelledError
    return join_origin_fates(forward, backward)


def join_origin_fates(forward: EscapeMap, backward: EscapeMap) -> OriginFateMap:
    """Join two maps of the same pixels, one forward and one backward in time.

    Parameters
    ----------
    forward, backward
        Complete maps whose requests differ only in `MapSpec.backward`.

    Raises
    ------
    ValueError
        When a map is not complete, or the requests differ in anything else.
    """
    if forward.spec.backward:
        raise ValueError("forward: has backward=True; must be a map forward in time")
    if backward.spec != replace(forward.spec, backward=True):
        raise ValueError(f"backward: is a map of {backward.spec}; must be {forward.spec} with backward=True")
    forward.check_complete("forward")
    backward.check_complete("backward")
    return OriginFateMap(forward.spec, forward.x, forward.ordinate, backward.fate, forward.fate)
