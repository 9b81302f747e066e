"""List the potentials of the contract tests: wells of the catalogue, and random potentials."""

from __future__ import annotations

import pytest

from engine import parse_formula
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.known_potentials import POTENTIALS

# Compiling kernels takes long, so normal runs compile those of the cases of the paper, and exhaustive runs those of all.
MARKS = {"I": (), "II": (), "III": (), "C5": (pytest.mark.slow,), "C8": (pytest.mark.slow,)}


# Wells with random terms of degree 3 and 4.
RANDOM = tuple(
    parse_formula(text)
    for text in (
        "0.725x² + 0.811y² + 0.105x³y + 0.362xy³ − 0.536y⁴",
        "0.879x² + 0.586y² + 0.905x³ + 0.446x²y² − 1.303y⁴",
        "0.432x² + 0.339y² − 2.441x²y + 1.8y³ + 1.144xy³",
    )
)
# Systems in rotating frames, and with bodies, have other tests.
WELLS = {name: potential for name, potential in POTENTIALS.items() if isinstance(potential.form, PolynomialForm)}
ALL = (*WELLS.values(), *RANDOM)

each_potential = pytest.mark.parametrize("potential", ALL, ids=lambda potential: potential.name)
each_compiled = pytest.mark.parametrize(
    "potential",
    [pytest.param(p, marks=MARKS.get(p.name, pytest.mark.exhaustive)) for p in ALL],
    ids=lambda potential: potential.name,
)
