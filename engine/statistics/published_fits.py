"""The curves that Zotos (2014) fits to the shares of those that escape, against energy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np


@dataclass(frozen=True)
class HyperbolicTangent:
    """½[1 + tanh(a h − b)], a share that rises from 0 to 1 about h = b/a; a and b are dimensionless."""

    a: float
    b: float

    def __call__(self, h: Any) -> Any:
        """The share at energies h of any shape."""
        return 0.5 * (1.0 + np.tanh(self.a * np.asarray(h, dtype=float) - self.b))

    @property
    def parameters(self) -> dict[str, float]:
        """Its parameters by name."""
        return {"a": self.a, "b": self.b}

    @property
    def formula(self) -> str:
        """The formula, to be read."""
        return f"½[1 + tanh({written(self.a)} h {_signed(-self.b)})]"


@dataclass(frozen=True)
class Polynomial:
    """c0 + c1 h + c2 h² + …, a share only in the range of the data; coefficients, lowest power first, are dimensionless."""

    coefficients: tuple[float, ...]

    def __call__(self, h: Any) -> Any:
        """The share at energies h of any shape."""
        return np.polynomial.polynomial.polyval(np.asarray(h, dtype=float), self.coefficients)

    @property
    def parameters(self) -> dict[str, float]:
        """Its coefficients by name."""
        return {f"c{power}": c for power, c in enumerate(self.coefficients)}

    @property
    def formula(self) -> str:
        """The formula, to be read."""
        powers = ("", " h", *(f" h{str(power).translate(_SUPERSCRIPTS)}" for power in range(2, len(self.coefficients))))
        first, *others = zip(self.coefficients, powers, strict=False)
        return " ".join([written(first[0]), *(_signed(c) + power for c, power in others)])


ShareCurve = HyperbolicTangent | Polynomial
"""A share of the starts against energy."""


@dataclass(frozen=True)
class PaperFits:
    """The fits printed for one case, on (x, px).

    Attributes
    ----------
    escaped
        Ne/N0.
    direct
        Nde/N0.
    lowest_energy, highest_energy
        The energies that the case is studied at, where the fits are meant: from the escape energy on.
    """

    escaped: HyperbolicTangent
    direct: Polynomial
    lowest_energy: float
    highest_energy: float


PAPER_FITS: Mapping[str, PaperFits] = MappingProxyType(
    {
        "I": PaperFits(HyperbolicTangent(30.0, 4.0), Polynomial((-1.7, 19.24, -49.15, 42.16)), 1.0 / 8.0, 0.5),
        "II": PaperFits(HyperbolicTangent(49.0, 6.5), Polynomial((-2.2, 22.86, -59.24, 51.42)), 1.0 / 6.0, 0.5),
        "III": PaperFits(HyperbolicTangent(15.85, 4.93), Polynomial((-1.496, 7.585, -5.938)), 0.25, 0.6),
    }
)
"""By case: the approximate formulas of Zotos (2014), Nonlinear Dynamics, doi 10.1007/s11071-014-1524-9, section 5."""


_SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def written(number: float) -> str:
    """A number as a formula shows it, to four digits."""
    return f"{number:.4g}".replace("-", "−").replace("inf", "∞")


def _signed(number: float) -> str:
    return f"{'−' if number < 0.0 else '+'} {written(abs(number))}"
