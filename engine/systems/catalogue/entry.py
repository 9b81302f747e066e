"""The entry of a potential in the catalogue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from engine.systems.parameters import WELL_PARAMETERS

_OF_WELLS = MappingProxyType({name: parameter.default for name, parameter in WELL_PARAMETERS.items()})


@dataclass(frozen=True)
class EnergyRange:
    """Energies of a potential, dimensionless.

    Attributes
    ----------
    low, high
        Its ends; `high` is also the upper end of the (x, h) plane.
    marked
        Energies of special interest, such as the nine of the paper.
    first
        Energy to begin with.
    decimals
        Decimals that distinguish the energies of the range.
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
        Its key in `CATALOGUE` and `POTENTIALS`, and the name of the potential.
    title
        Display name.
    formula
        V as text, in the notation of `engine.systems.formulas.formula_parser.parse_formula`, without the centrifugal term.
    description
        One sentence.
    reference
        Source in the literature.
    parameters
        The values by name of the letters of the formula and of the rotation; for wells also those of `Potential.with_parameters`.
    adjustable
        The names of those that can be chosen.
    energies
        Energies to explore at these values; None for the range that follows from the potential.
    """

    name: str
    title: str
    formula: str
    description: str = ""
    reference: str = ""
    parameters: Mapping[str, float] = field(default_factory=lambda: _OF_WELLS)
    adjustable: tuple[str, ...] = tuple(_OF_WELLS)
    energies: EnergyRange | None = None

    @property
    def is_well(self) -> bool:
        """Whether it has ω1, ω2 and ε."""
        return "epsilon" in self.parameters
