"""Origin and fate: through which exit orbits came in, joined with the one through which they leave."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from engine.dynamics.fates import Fate
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap, describe_codes
from engine.maps.spec import MapSpec


@dataclass(frozen=True, eq=False)
class OriginFateMap:
    """Where the orbit through each pixel comes from and where it goes.

    Attributes
    ----------
    spec
        The request for the map of fates.
    x, ordinate
        (columns,), (rows,) pixel centres.
    origin, fate
        (rows, columns) int8: the channel k ≥ 1 through which the orbit came in, or leaves, or a `Fate`; bounded is an orbit
        that was inside all the time back to −t_max, or will be to t_max. Read-only.
    """

    spec: MapSpec
    x: np.ndarray
    ordinate: np.ndarray
    origin: np.ndarray
    fate: np.ndarray

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return self.origin.nbytes + self.fate.nbytes + self.x.nbytes + self.ordinate.nbytes

    def count_passages(self) -> np.ndarray:
        """(channels + 1, channels + 1) int64: starts by origin (row) and fate (column); 0 is bounded, k channel k."""
        size = self.spec.potential.channels + 1
        known = (self.origin >= 0) & (self.fate >= 0)
        pairs = self.origin[known].astype(np.int64) * size + self.fate[known]
        return np.bincount(pairs, minlength=size * size).reshape(size, size)

    def describe(self) -> str:
        """How the orbits pass, in a sentence."""
        counts = self.count_passages()
        total = max(int(counts.sum()), 1)
        through, same = int(counts[1:, 1:].sum()), int(np.trace(counts[1:, 1:]))
        return (
            f"{through / total:.1%} of the interior starts lie on orbits that come in and leave, {same / total:.1%} by one and "
            f"the same channel; {counts[0, 0] / total:.1%} are bounded both ways, the rest one way."
        )

    def to_xarray(self) -> xr.Dataset:
        """The map with named axes and what made it, fit for NetCDF."""
        plane = self.spec.plane
        dims = (plane.ordinate, "x")
        variables: dict[str, Any] = {
            name: (dims, image, {"long_name": f"channel the orbit {way} by (k >= 1) or outcome code", **describe_codes(Fate)})
            for name, way, image in (("origin", "came in", self.origin), ("fate", "leaves", self.fate))
        }
        coordinates = {plane.ordinate: self.ordinate, "x": self.x}
        return xr.Dataset(variables, coordinates, self.spec.provenance())


def compute_origin_fates(spec: MapSpec, cancel: threading.Event | None = None, executor: Executor | None = None) -> OriginFateMap:
    """Follow the orbit through each pixel both ways in time.

    Potentials are even in velocity: the past of (x, y, px, py) is the future of (x, y, −px, −py).

    Parameters
    ----------
    spec
        The request for the map of fates; its own direction does not matter.
    cancel
        When set, the work stops within about 0.1 s.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When no exit is defined at an energy that `spec` asks for.
    """
    both = [compute_map(replace(spec, backward=backward), None, cancel, executor) for backward in (False, True)]
    if not all(one.complete for one in both):
        raise CancelledError
    return join_origin_fates(*both)


def join_origin_fates(forward: EscapeMap, backward: EscapeMap) -> OriginFateMap:
    """The same from two maps that are there already.

    Parameters
    ----------
    forward, backward
        Complete maps whose requests differ in direction only.

    Raises
    ------
    ValueError
        When they are not.
    """
    if backward.spec != replace(forward.spec, backward=True) or forward.spec.backward:
        raise ValueError(f"backward: a map of {backward.spec} is not {forward.spec} followed into the past")
    for name, one in (("forward", forward), ("backward", backward)):
        if not one.complete:
            raise ValueError(f"{name}: is not complete")
    return OriginFateMap(forward.spec, forward.x, forward.ordinate, backward.fate, forward.fate)
