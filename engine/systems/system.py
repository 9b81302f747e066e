"""A potential chosen by users: a name of the catalogue or a formula, with parameters by name."""

from __future__ import annotations

import reprlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

from engine.foundations.validation import check_type
from engine.systems.catalogue.entry import CatalogueEntry
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.formulas.formula_parser import LARGEST_VALUE, formula_letters, parse_formula
from engine.systems.formulas.formula_writer import write_formula
from engine.systems.parameters import ROTATION, WELL_PARAMETERS, symbol_of
from engine.systems.potential import Potential

TYPED = "typed"
"""The case of a potential that is given by a formula."""

SHOWN_DIGITS = 12
"""Significant digits of coefficients in formulas. With 12 digits, 1.46²/2 is shown as 1.0658, without a rounding error."""


@dataclass(frozen=True)
class System:
    """A potential with its parameters: ω1, ω2 and ε of Zotos (2014), the rotation Ω of the frame, and the letters of a formula.

    V = ½(ω1² x² + ω2² y²) + ε V1 − ½ Ω² (x² + y²). Systems of the catalogue that are not wells have letters of their own.

    Attributes
    ----------
    case
        A key of `POTENTIALS`, or "typed" for a formula.
    formula
        V(x, y) as text for a formula; otherwise empty.
    parameters
        Values by name: omega_1, omega_2 and epsilon as in `Potential.with_parameters`, rotation as in
        `Potential.in_rotating_frame`, and the letters of the formula as in `parse_formula`. Parameters with their default values
        (see `default_of`) are left out.

    Raises
    ------
    ValueError
        If the catalogue has no entry `case`, or an argument has a wrong type.
    """

    case: str
    formula: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_type("case", self.case, str)
        check_type("formula", self.formula, str)
        check_type("parameters", self.parameters, Mapping)
        # The property raises the error for an unknown case.
        _ = self.entry
        # Titles and links must not depend on the order in which parameters were chosen.
        positions = {name: position for position, name in enumerate(WELL_PARAMETERS)}
        sorted_names = sorted(self.parameters, key=lambda name: (positions.get(name, len(positions)), name))
        changed = {name: self.parameters[name] for name in sorted_names if self.parameters[name] != self.default_of(name)}
        object.__setattr__(self, "parameters", changed)

    def __hash__(self) -> int:
        return hash((self.case, self.formula, tuple(self.parameters.items())))

    @classmethod
    def from_formula(cls, formula: str, **parameters: float) -> System:
        """Make the system of a formula, with values of its letters, of omega_1, omega_2 and epsilon, and of the rotation.

        Examples
        --------
        >>> from escape_explorer import ParameterAxis, System
        >>> system = System.from_formula("½(x² + y²) − b x²y", b=0.5, rotation=0.1)
        >>> system.potential.channels, ParameterAxis("b", 0.5, 2.0, system).symbol
        (1, 'b')
        """
        return cls(TYPED, formula, parameters)

    @property
    def entry(self) -> CatalogueEntry:
        """The entry of the catalogue; for a typed formula, an equivalent entry."""
        return CatalogueEntry("", "Typed potential", self.formula) if self.case == TYPED else CATALOGUE[self.case]

    @cached_property
    def potential(self) -> Potential:
        """The potential; ValueError if the formula or a parameter is invalid."""
        return _make_potential(self)

    @property
    def letters(self) -> dict[str, float]:
        """The values of the letters of a typed formula; empty if the formula has an unknown character or too many letters."""
        try:
            return {name: self.value_of(name) for name in formula_letters(self.formula)}
        except ValueError:
            return {}

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """The names of the parameters that users can choose, and of the letters of a typed formula."""
        return (*self.entry.adjustable, *self.letters)

    def default_of(self, name: str) -> float:
        """Return the default value of a parameter."""
        other = WELL_PARAMETERS[name].default if name in WELL_PARAMETERS else 1.0
        return self.entry.parameters.get(name, other)

    def range_of(self, name: str) -> tuple[float, float]:
        """Return the smallest and the largest legal value of a parameter."""
        return WELL_PARAMETERS[name].range if name in WELL_PARAMETERS else (-LARGEST_VALUE, LARGEST_VALUE)

    def value_of(self, name: str) -> float:
        """Return the value of a parameter."""
        return self.parameters.get(name, self.default_of(name))

    def with_parameter(self, name: str, value: float) -> System:
        """Return the system with another value of one parameter."""
        return replace(self, parameters={**self.parameters, name: value})

    @property
    def as_typed(self) -> System:
        """The same system given by a formula. For a well, ω1, ω2 and ε become numbers; other formulas keep their letters."""
        if self.case == TYPED:
            return self
        if self.entry.is_well:
            at_rest = self.with_parameter(ROTATION, 0.0).potential
            return System(TYPED, write_formula(at_rest, SHOWN_DIGITS), {ROTATION: self.value_of(ROTATION)})
        return System(TYPED, self.entry.formula, {**self.entry.parameters, **self.parameters})

    @property
    def well_parameters(self) -> dict[str, float]:
        """The values of ω1, ω2 and ε that differ from their defaults."""
        return {name: value for name, value in self.parameters.items() if name in WELL_PARAMETERS and name != ROTATION}

    @property
    def letter_parameters(self) -> dict[str, float]:
        """The values of letters that differ from their defaults."""
        return {name: value for name, value in self.parameters.items() if name not in WELL_PARAMETERS}

    @property
    def title(self) -> str:
        """Name of the potential, with the parameters that differ from their defaults."""
        changed = ", ".join(f"{symbol_of(name)} = {value:.6g}" for name, value in self.parameters.items())
        return f"{self.entry.title} with {changed}" if changed else self.entry.title

    @property
    def formula_shown(self) -> str:
        """V(x, y) as text, with the values of parameters and letters, and with the shift of the axes, if any."""
        if self.case != TYPED and not (self.parameters and self.entry.is_well):
            return self.entry.formula
        if self.value_of(ROTATION):
            return self.as_typed.formula
        potential = self.potential
        if any(potential.origin):
            x, y = potential.origin
            return f"{potential.name}, where x and y count from ({x:.6g}, {y:.6g})"
        return write_formula(potential, SHOWN_DIGITS)


@lru_cache(maxsize=64)
def _make_potential(system: System) -> Potential:
    entry = system.entry
    if system.case != TYPED and (unknown := [name for name in system.parameters if name not in entry.adjustable]):
        legal = ", ".join(entry.adjustable) or "none"
        raise ValueError(f"parameters: {reprlib.repr(unknown[0])} is not a parameter of {system.case}; it has {legal}")
    values = {**entry.parameters, **system.parameters}
    letters = {name: value for name, value in values.items() if name not in WELL_PARAMETERS}
    well_values = {name: value for name, value in values.items() if name in WELL_PARAMETERS and name != ROTATION}
    potential = parse_formula(entry.formula, entry.name, letters).with_parameters(**well_values)
    return replace(potential.in_rotating_frame(system.value_of(ROTATION)), system=system)
