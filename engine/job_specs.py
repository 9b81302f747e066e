"""Requests that are not maps: frozen and hashable, so that they are the keys under which their answers are kept."""

from __future__ import annotations

from dataclasses import dataclass

from engine.escape_maps import EscapeMap
from engine.map_specs import MapSpec
from engine.planes import Plane
from engine.potentials import Potential
from engine.twins import Twin


@dataclass(frozen=True)
class OrbitSpec:
    """The request for one orbit: `integrate_orbit`'s arguments, hashable."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float


@dataclass(frozen=True)
class TwinSpec:
    """The request for the twin of a start: `find_twin`'s arguments, hashable."""

    potential: Potential
    plane: Plane
    energy: float | tuple[float, float]
    x: float
    ordinate: float
    t_max: float


@dataclass(frozen=True)
class TwinAnswer:
    """A twin, or the knowledge that there is none."""

    twin: Twin | None
    nbytes: int = 1024
    """About what it takes together with its request."""


@dataclass(frozen=True)
class SeparationSpec:
    """The request to compare two orbits: `compute_separation`'s arguments, hashable."""

    potential: Potential
    first: tuple[float, float, float, float]
    second: tuple[float, float, float, float]
    t_end: float


@dataclass(frozen=True)
class PreviewSpec:
    """The request for a quick look at a map."""

    map_spec: MapSpec


@dataclass(frozen=True)
class RegularitySpec:
    """The request to judge the bounded orbits of a map."""

    map_spec: MapSpec


@dataclass(frozen=True, eq=False)
class Preview:
    """A preview as it is kept: whole, for what it is."""

    frame: EscapeMap

    @property
    def nbytes(self) -> int:
        """Bytes held."""
        return self.frame.nbytes
