"""The curves that Zotos (2014) fitted to the share of escapes against energy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from engine.foundations.wording import format_number


@dataclass(frozen=True)
class HyperbolicTangent:
    """The share ½[1 + tanh(a h − b)], which rises from 0 to 1 around h = b/a. a and b are dimensionless."""

    a: float
    b: float

    def __call__(self, h: Any) -> Any:
        """Return the share at energies h, an array of any shape."""
        return 0.5 * (1.0 + np.tanh(self.a * np.asarray(h, dtype=float) - self.b))

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters by name."""
        return {"a": self.a, "b": self.b}

    @property
    def formula(self) -> str:
        """The formula as text."""
        return f"½[1 + tanh({format_number(self.a)} h {_format_term(-self.b)})]"


@dataclass(frozen=True)
class Polynomial:
    """The share c0 + c1 h + c2 h² + …, valid in the range of the data. Coefficients (lowest power first) are dimensionless."""

    coefficients: tuple[float, ...]

    def __call__(self, h: Any) -> Any:
        """Return the share at energies h, an array of any shape."""
        return np.polynomial.polynomial.polyval(np.asarray(h, dtype=float), self.coefficients)

    @property
    def degree(self) -> int:
        """The highest power of h."""
        return len(self.coefficients) - 1

    @property
    def parameters(self) -> dict[str, float]:
        """Coefficients by name."""
        return {f"c{power}": c for power, c in enumerate(self.coefficients)}

    @property
    def formula(self) -> str:
        """The formula as text."""
        constant, *others = self.coefficients
        powers = ("h", *(f"h{str(power).translate(_SUPERSCRIPTS)}" for power in range(2, len(self.coefficients))))
        # A constant has no other coefficients.
        terms = [f"{_format_term(c)} {power}" for c, power in zip(others, powers, strict=False)]
        return " ".join([format_number(constant), *terms])


ShareCurve = HyperbolicTangent | Polynomial
"""Share of the starts as a function of energy."""


@dataclass(frozen=True)
class PaperFits:
    """Fits published for one case, on (x, px).

    Attributes
    ----------
    escaped
        Fit of Ne/N0, the share of escapes.
    direct
        Fit of Nde/N0, the share of direct escapes.
    highest_energy
        Upper end of the energy range of the fits (dimensionless). The range begins at the escape energy.
    """

    escaped: HyperbolicTangent
    direct: Polynomial
    highest_energy: float


PAPER_FITS: Mapping[str, PaperFits] = MappingProxyType(
    {
        "I": PaperFits(HyperbolicTangent(30.0, 4.0), Polynomial((-1.7, 19.24, -49.15, 42.16)), 0.5),
        "II": PaperFits(HyperbolicTangent(49.0, 6.5), Polynomial((-2.2, 22.86, -59.24, 51.42)), 0.5),
        "III": PaperFits(HyperbolicTangent(15.85, 4.93), Polynomial((-1.496, 7.585, -5.938)), 0.6),
    }
)
"""Approximate formulas by case, from Zotos (2014), Nonlinear Dynamics, doi 10.1007/s11071-014-1524-9, section 5."""

_SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def _format_term(value: float) -> str:
    """Write a number as an operator and an operand, such as "+ 2.5"."""
    return f"{'−' if value < 0.0 else '+'} {format_number(abs(value))}"
