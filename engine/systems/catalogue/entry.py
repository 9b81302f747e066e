"""Entries of the catalogue of potentials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from engine.systems.parameters import WELL_PARAMETERS

# Default values of the parameters of a well.
_WELL_DEFAULTS = MappingProxyType({name: parameter.default for name, parameter in WELL_PARAMETERS.items()})


@dataclass(frozen=True)
class EnergyRange:
    """The energies at which a potential is explored, dimensionless.

    Attributes
    ----------
    low, high
        The ends of the range. `high` is also the upper end of the (x, h) plane.
    marked
        Energies of special interest, such as the nine of the paper.
    first
        The energy shown first.
    decimals
        Number of decimals that distinguish the energies of the range.
    """

    low: float
    high: float
    marked: tuple[float, ...]
    first: float
    decimals: int = 3


@dataclass(frozen=True)
class CatalogueEntry:
    """A row of the catalogue.

    Attributes
    ----------
    name
        Key in `CATALOGUE` and `POTENTIALS`, and name of the potential.
    title
        Display name.
    formula
        V as text, in the notation of `engine.systems.system.parse_formula`, without the centrifugal term.
    description
        One sentence on the physics and the exits.
    reference
        Source in the literature.
    parameters
        Default values by name, of the letters of the formula, the rotation and, for wells, the parameters of
        `Potential.with_parameters`.
    adjustable
        The names of the parameters that users can choose.
    energies
        Energies to explore at the values of `parameters`; None for the range derived from the potential.
    sections
        Surfaces of section in use for the system besides y = 0, such as that of the reference or those through its bodies and
        its libration points, as text, see `read_section`.
    """

    name: str
    title: str
    formula: str
    description: str = ""
    reference: str = ""
    parameters: Mapping[str, float] = field(default_factory=lambda: _WELL_DEFAULTS)
    adjustable: tuple[str, ...] = tuple(_WELL_DEFAULTS)
    energies: EnergyRange | None = None
    sections: tuple[str, ...] = ()

    @property
    def is_well(self) -> bool:
        """Whether `Potential.with_parameters` sets the parameters ω1, ω2 and ε of the potential."""
        return "epsilon" in self.parameters
