"""Make wells that are even in x, in y or in both."""

from __future__ import annotations

import numpy as np

from engine import Potential, parse_formula

VALLEYS = "(1.0909x^2+0.8848y^2+1.1770)^0.6 + 0.9810 y^4 exp(-y^2) + 0.8755 x y^2 sin(1+x)"
"""A well that is even in y, with a long valley along y = 0 that is a ridge in several places, and exits on both sides of it."""

# The letters u and v stand for x and y in either order. All are even in v, and the last three also in u.
_FORMULAS = (
    "½(a u² + b v²) − k u v² + 0.3 q u³",
    "½(a u² + b v²) − k u² v² − 0.2 q u³",
    "½(a u² + b v²) − 0.5 k u v⁴ + 0.2 q u⁵ − 0.1 c v⁶ + 0.1 u² v²",
    "−cos(a u) − b cos(v) + 0.2 k u v² + 0.2 q u² v²",
    "½ log(a u² + b v² + c) − 0.1 k u v² − 0.1 q u³",
    "½(a u² + b v²) − k u² v² + 0.1 q (u⁴ − c v⁴)",
    "½(a u² + b v²) − k u² v² exp(−0.2(u² + v²)) − 0.1 q u⁴",
    "½(a u² + b v²) − k u² v⁴ − 0.2 q u⁴ v²",
)


def exchanged(formula: str) -> str:
    """Return a formula of x and y with its axes exchanged."""
    return formula.replace("exp", "EXP").translate(str.maketrans("xy", "yx")).replace("EXP", "exp")


def random_symmetric_well(seed: int) -> Potential:
    """Return a well with one or two mirror symmetries."""
    random = np.random.default_rng([58, seed])
    formula = _FORMULAS[seed % len(_FORMULAS)].replace("u", "x").replace("v", "y")
    values = dict(zip("abckq", random.uniform(0.4, 1.4, 5).round(4).tolist(), strict=True))
    parameters = {name: value for name, value in values.items() if name in formula.replace("cos", "")}
    return parse_formula(formula if seed // len(_FORMULAS) % 2 else exchanged(formula), parameters=parameters)
