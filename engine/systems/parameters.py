"""The parameters that every well has: ω1, ω2 and ε of Zotos (2014), and the rotation Ω of the frame."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from engine.foundations.validation import LARGEST_NUMBER


class Parameter(NamedTuple):
    """The symbol of a parameter in texts, its default value, and its smallest and largest legal value, dimensionless."""

    symbol: str
    default: float
    range: tuple[float, float]


ROTATION = "rotation"
"""Name of the parameter Ω."""

WELL_PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {
        "omega_1": Parameter("ω1", 1.0, (0.1, 10.0)),
        "omega_2": Parameter("ω2", 1.0, (0.1, 10.0)),
        "epsilon": Parameter("ε", 1.0, (0.01, 100.0)),
        ROTATION: Parameter("Ω", 0.0, (-LARGEST_NUMBER, LARGEST_NUMBER)),
    }
)
"""Parameters by name: those of `Potential.with_parameters`, and the rate of `Potential.in_rotating_frame`."""


def symbol_of(name: str) -> str:
    """Return the symbol of a parameter. A letter of a formula is its own symbol."""
    return WELL_PARAMETERS[name].symbol if name in WELL_PARAMETERS else name
