"""What the catalogue says of a potential."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

from engine.potentials.energy_ranges import EnergyRange
from engine.potentials.formulas.formula_parser import parse_formula
from engine.potentials.potential import Potential

ROTATION = "rotation"
"""Name of the parameter Ω."""

WELL_PARAMETERS = ("omega_1", "omega_2", "epsilon")
"""Names of ω1, ω2 and ε of Zotos (2014)."""

_OF_WELLS = MappingProxyType({**dict.fromkeys(WELL_PARAMETERS, 1.0), ROTATION: 0.0})


@dataclass(frozen=True, eq=False)
class PotentialEntry:
    """A potential with its description.

    Attributes
    ----------
    name
        Its key in `POTENTIALS` and `CATALOGUE`, and the name of the potential.
    title
        Display name.
    formula
        V as text, in the notation of `engine.potentials.formulas.formula_parser.parse_formula`, without the centrifugal term.
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
    description: str
    reference: str
    parameters: Mapping[str, float] = field(default_factory=lambda: _OF_WELLS)
    adjustable: tuple[str, ...] = tuple(_OF_WELLS)
    energies: EnergyRange | None = None

    @cached_property
    def potential(self) -> Potential:
        """The potential at the values of the catalogue."""
        return self.build({})

    def build(self, chosen: Mapping[str, float]) -> Potential:
        """The potential at chosen values of some parameters; ValueError if one is out of range."""
        values = {**self.parameters, **chosen}
        letters = {name: value for name, value in values.items() if name not in _OF_WELLS}
        well = {name: values[name] for name in WELL_PARAMETERS if name in values}
        plain = parse_formula(self.formula, self.name, letters).with_parameters(**well)
        return plain.in_rotating_frame(values[ROTATION])
