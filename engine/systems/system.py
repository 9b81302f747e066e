"""A potential chosen by users: a name of the catalogue or a formula, with parameters by name."""

from __future__ import annotations

import reprlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

from engine.foundations.validation import check_type, checked_items, checked_number, checks_types, short_repr
from engine.foundations.wording import format_number, format_point
from engine.systems.catalogue.entry import CatalogueEntry
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.formulas.formula_parser import LARGEST_VALUE, formula_letters, make_potential
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
        If the catalogue has no entry `case`, the entry lacks a parameter, or an argument has a wrong type.
    """

    case: str
    formula: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_type("case", self.case, str)
        check_type("formula", self.formula, str)
        check_type("parameters", self.parameters, Mapping)
        names = checked_items("parameters", self.parameters, str)
        self._check_names()
        parameters = {name: checked_number(name, self.parameters[name]) for name in names}
        # Titles and links must not depend on the order in which parameters were chosen.
        positions = {name: position for position, name in enumerate(WELL_PARAMETERS)}
        sorted_names = sorted(parameters, key=lambda name: (positions.get(name, len(positions)), name))
        changed = {name: parameters[name] for name in sorted_names if parameters[name] != self.default_of(name)}
        object.__setattr__(self, "parameters", changed)

    def _check_names(self) -> None:
        """Raise ValueError for an unknown case, and for a parameter that its entry lacks or a formula beside its own."""
        legal = self.entry.adjustable
        if self.case != TYPED and self.formula:
            raise ValueError(f"formula={short_repr(self.formula)}: must be empty for {self.case}, which has a formula")
        if self.case != TYPED and (unknown := [name for name in self.parameters if name not in legal]):
            names = ", ".join(legal) or "none"
            raise ValueError(f"parameters: {reprlib.repr(unknown[0])} is not a parameter of {self.case}; it has {names}")

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

    def with_factors(self, factors: Mapping[str, float]) -> System:
        """Return the system with parameters multiplied by factors."""
        return replace(self, parameters={**self.parameters, **{name: self.value_of(name) * factors[name] for name in factors}})

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
    def letter_parameters(self) -> dict[str, float]:
        """The values of letters that differ from their defaults."""
        return {name: value for name, value in self.parameters.items() if name not in WELL_PARAMETERS}

    @property
    def title(self) -> str:
        """Name of the potential, with the parameters that differ from their defaults."""
        changed = ", ".join(f"{symbol_of(name)} = {format_number(value, 6)}" for name, value in self.parameters.items())
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
            return f"{potential.name}, where x and y count from {format_point(*potential.origin)}"
        return write_formula(potential, SHOWN_DIGITS)


@lru_cache(maxsize=64)
def _make_potential(system: System) -> Potential:
    entry = system.entry
    values = {**entry.parameters, **system.parameters}
    letters = {name: value for name, value in values.items() if name not in WELL_PARAMETERS}
    well_values = {name: value for name, value in values.items() if name in WELL_PARAMETERS and name != ROTATION}
    potential = make_potential(entry.formula, entry.name, letters).with_parameters(**well_values)
    return replace(potential.in_rotating_frame(system.value_of(ROTATION)), system=system)


@checks_types(text=str, name=(str, type(None)), parameters=(Mapping, type(None)))
def parse_formula(text: str, name: str | None = None, parameters: Mapping[str, float] | None = None) -> Potential:
    """Return the potential given by a formula.

    Parameters
    ----------
    text
        A formula in x and y of at most 500 characters:

        - numbers (2, 0.5, 1e-3, ½), x, y and r = √(x² + y²);
        - + − * / ^ ** √ and round brackets, also "·" and "×". "2x²y" is a product, and "1/2 x" is half of x;
        - exp(), log() or ln(), sin(), cos() and sqrt();
        - exponents from −12 to 12;
        - at most 8 letters for parameters, each with or without one digit: "a", "k1", "α". Greek letters and all Latin letters
          except e, t, z, E and V are allowed. "px", "py", "vx" and "vy" are refused;
        - "V =" in front, which is ignored.

        Clauses can follow:

        - "; centre the Moon (0, 0) 0.0045": a body with a name, its place and its radius of collision;
        - "; escape 10": an escape radius;
        - "; well (1, 0)": a place near a minimum, to which the axes are moved, see `Potential.at_minimum`;
        - "; exits L2, L1": names of the exits in channel order;
        - "; masses (8, 8)": the masses of px²/2m₁ + py²/2m₂, which must be equal. For two masses write V(x/√m₁, y/√m₂), whose
          axes are √m₁ x and √m₂ y.
    name
        Name of the potential; by default the formula as written by `write_formula`.
    parameters
        Values of letters, at most 1e9 in magnitude; by default 1. A value is substituted as the decimal that Python prints.

    Returns
    -------
    The potential, whose letters can be varied along a `ParameterAxis`. A polynomial is expanded exactly, with each coefficient
    rounded once and the terms sorted by degree; a constant term is kept.

    Raises
    ------
    ValueError
        A `FormulaError` with the position and the problem:

        - the text cannot be parsed, or has more than 500 characters, more than 50 nested brackets or roots, neither x nor y, or a
          function of a number outside the domain of the function;
        - a polynomial has a degree above 12, more than 60 terms, or a coefficient whose magnitude is not between 1e-9 and 1e9;
        - another formula and its derivatives up to the second have more than 120 products and functions.

        Any other ValueError: a parameter is not a letter of the formula, its value is not legal, or V has no minimum to which
        the axes could be moved.

    Examples
    --------
    >>> from escape_explorer import parse_formula
    >>> potential = parse_formula("½(x² + y²) + x²y − y³/3")
    >>> potential.channels, round(potential.escape_energy, 6)
    (3, 0.166667)
    >>> parse_formula("½(x² + y²) − a x y²", parameters={"a": 1.5}).name
    'x²/2 + y²/2 − 3xy²/2'
    >>> parse_formula("½r² − a x²y exp(−y²)", parameters={"a": 2}).channels
    2
    """
    system = System(TYPED, text, parameters or {})
    return replace(make_potential(text, name or "", system.letter_parameters), system=system)
