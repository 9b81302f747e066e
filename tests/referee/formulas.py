"""Make random formulas of four grammars, and list examples that were once answered wrongly.

The texts have explicit products and powers, so that SymPy reads the same formula as the engine. `REPEATS` successive seeds have
the same structure with other numbers, because compiled functions depend on the structure alone.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import sympy

from engine import Potential, parse_formula
from tests.channel_family import channel_family

REPEATS = 3
X, Y = sympy.symbols("x y", real=True)


@dataclass(frozen=True)
class Formula:
    """A formula, the place of its well if it is not at the origin, and energies for examples; all is dimensionless."""

    expression_text: str
    well: tuple[float, float] | None = None
    energies: tuple[float, ...] = ()
    state: tuple[float, float, float, float] | None = None

    @property
    def text(self) -> str:
        """The text for the engine."""
        return self.expression_text if self.well is None else f"{self.expression_text}; well ({self.well[0]}, {self.well[1]})"

    @cached_property
    def expression(self) -> sympy.Expr:
        """V with exact numbers."""
        return sympy.sympify(self.expression_text.replace("^", "**"), locals={"x": X, "y": Y}, rational=True)

    def parse(self) -> Potential:
        """The potential of the engine."""
        return parse_formula(self.text)


def random_formula(seed: int) -> Formula:
    """Return the formula of a seed."""
    structure, numbers = random.Random(f"structure {seed // REPEATS}"), random.Random(f"numbers {seed}")
    return GRAMMARS[list(GRAMMARS)[seed // REPEATS % len(GRAMMARS)]](structure, numbers)


def _number(numbers: random.Random, low: float = 0.3, high: float = 1.5) -> str:
    return f"{numbers.uniform(low, high):.4f}"


def _small_number(numbers: random.Random) -> str:
    """Return a number of any magnitude between 1e-4 and 1."""
    return f"{10.0 ** numbers.uniform(-4.0, 0.0):.6f}"


def _sign(structure: random.Random) -> str:
    return structure.choice("+-")


def _harmonic(numbers: random.Random) -> str:
    return f"0.5*({_number(numbers)}*x^2+{_number(numbers)}*y^2)"


def _polynomial(structure: random.Random, numbers: random.Random) -> Formula:
    degree = structure.randint(3, 8)
    powers = [(i, n - i) for n in range(3, degree + 1) for i in range(n + 1)]
    chosen = structure.sample(powers, min(len(powers), structure.randint(1, 4)))
    number = structure.choice([_number, _small_number])
    return Formula(_harmonic(numbers) + "".join(f"{_sign(structure)}{number(numbers)}*x^{i}*y^{j}" for i, j in chosen))


_POWERS = ("x^3", "x^2*y", "x*y^2", "y^3", "x^2*y^2", "x^4", "y^4", "x^3*y")
_FACTORS: tuple[Callable[[random.Random], str], ...] = (
    lambda n: f"exp(-{_number(n)}*(x^2+y^2))",
    lambda n: f"exp(-{_number(n)}*y^2)",
    lambda n: f"cos({_number(n)}*x+{_number(n)}*y)",
    lambda n: f"sin({_number(n)}+x)",
    lambda n: f"1/(1+{_number(n)}*x^2+{_number(n)}*y^2)",
    lambda n: f"sqrt(1+{_number(n)}*(x+y)^2)",
)
_WELLS: tuple[Callable[[random.Random], str], ...] = (
    _harmonic,
    lambda n: f"({_number(n)}*x^2+{_number(n)}*y^2+{_number(n)})^0.6",
    lambda n: f"-{_number(n)}/sqrt({_number(n)}*x^2+{_number(n)}*y^2+{_number(n)})",
    lambda n: f"0.5*log({_number(n)}*x^2+{_number(n)}*y^2+1)",
    lambda n: f"0.5*{_number(n)}*x^2+{_number(n, 1.0, 50.0)}*(1-exp(-{_number(n, 0.05, 1.0)}*y))^2",
    lambda n: f"{_number(n)}*(1-exp(-{_number(n)}*x))^2+{_number(n)}*(1-exp(-{_number(n)}*y))^2",
    lambda n: f"0.5*{_number(n)}*x^2-{_number(n, 1.0, 9.0)}/(exp({_number(n)}*y)+exp(-{_number(n)}*y))^2",
    lambda n: f"0.5*{_number(n)}*x^2+0.5*y^2/(1+{_small_number(n)}*y^2)",
    lambda n: f"0.5*(x^2+y^2)-{_number(n, 0.1, 0.4)}*exp(-{_number(n)}*(x^2+y^2))",
)


def _expression(structure: random.Random, numbers: random.Random) -> Formula:
    if structure.random() < 0.3:
        return _wells_below_infinity(structure, numbers)
    terms = [
        f"{_sign(structure)}{_number(numbers)}*{structure.choice(_POWERS)}*{structure.choice(_FACTORS)(numbers)}"
        for _ in range(structure.randint(0, 2))
    ]
    return Formula(structure.choice(_WELLS)(numbers) + "".join(terms))


def _wells_below_infinity(structure: random.Random, numbers: random.Random) -> Formula:
    """Return two or three wells below V(∞), alone or along a channel."""
    places = [(numbers.uniform(-0.3, 0.3), numbers.uniform(1.6, 2.2) * k) for k in (-1, 1, 0)[: structure.choice([2, 2, 3])]]
    channel = structure.random() < 0.5
    wells = (f"-{_number(numbers, 1.0, 2.5)}/(1+{'' if channel else f'(x-({px:.3f}))^2+'}(y-({py:.3f}))^2)" for px, py in places)
    px, py = places[1]
    return Formula(("0.5*x^2" if channel else "") + "".join(wells), well=(0.0 if channel else round(px, 3), round(py, 3)))


def _symmetric(structure: random.Random, numbers: random.Random) -> Formula:
    return structure.choice([_even_polynomial, _three_fold, _narrow_valley, _even_expression, _channel_family])(
        structure, numbers
    )


def _even_polynomial(structure: random.Random, numbers: random.Random) -> Formula:
    powers = [(i, n - i) for n in range(3, 7) for i in range(n + 1) if (n - i) % 2 == 0]
    chosen = structure.sample(powers, structure.randint(1, 3))
    return Formula(_harmonic(numbers) + "".join(f"{_sign(structure)}{_number(numbers)}*x^{i}*y^{j}" for i, j in chosen))


def _three_fold(structure: random.Random, numbers: random.Random) -> Formula:
    faded = structure.choice(["", f"*exp(-{_number(numbers, 0.1, 0.4)}*(x^2+y^2))"])
    added = structure.choice(["", f"+{_small_number(numbers)}*(x^2+y^2)^2"])
    return Formula(f"0.5*(x^2+y^2)+{_number(numbers, 0.3, 2.0)}*(x^3-3*x*y^2){faded}{added}")


def _narrow_valley(structure: random.Random, numbers: random.Random) -> Formula:
    turn = structure.choice(["sin", "cos"])
    return Formula(
        f"({_number(numbers)}*x^2+{_number(numbers)}*y^2+{_number(numbers)})^0.6+{_number(numbers)}*y^4*exp(-y^2)"
        f"+{_number(numbers)}*x*y^2*{turn}(1+x)"
    )


def _even_expression(structure: random.Random, numbers: random.Random) -> Formula:
    power = structure.choice(["x^2*y^2", "x*y^2", "x^3", "y^4"])
    factor = structure.choice(["exp(-{}*y^2)", "cos({}*x)", "1/(1+{}*y^2)", "exp(-{}*(x^2+y^2))"]).format(_number(numbers))
    return Formula(f"{structure.choice(_WELLS[:4])(numbers)}{_sign(structure)}{_number(numbers)}*{power}*{factor}")


def _bent(structure: random.Random, numbers: random.Random) -> Formula:
    """Return a long well along a curve, with exits across it that other parts of the well can face."""
    u = structure.choice(["(x-{}*y^2)", "(x-{}*y^3)", "(x-{}*sin(y))"]).format(f"{10.0 ** numbers.uniform(-1.5, -0.3):.4f}")
    walls = structure.choice(["{}*{}^3", "{}*{}^4", "{}*{}^2*y^2"]).format(_number(numbers, 0.2, 0.6), u)
    return Formula(f"0.5*{u}^2-{walls}+{10.0 ** numbers.uniform(-2.5, -0.3):.4f}*y^2")


def _channel_family(structure: random.Random, _numbers: random.Random) -> Formula:
    return Formula(_channels(structure.randint(3, 8)))


def _channels(n: int) -> str:
    """Return the text of `channel_family` with n exits."""
    return "+".join(f"({c!r})*x^{i}*y^{j}" for i, j, c in channel_family(n).terms)


GRAMMARS: Mapping[str, Callable[[random.Random, random.Random], Formula]] = {
    "polynomial": _polynomial,
    "expression": _expression,
    "symmetric": _symmetric,
    "bent": _bent,
}
"""Makers of formulas, by grammar."""

EXAMPLES: Mapping[str, Formula] = {
    "narrow valleys, even in y": Formula(
        "(1.0909*x^2+0.8848*y^2+1.1770)^0.6+0.9810*y^4*exp(-y^2)+0.8755*x*y^2*sin(1+x)",
        energies=(6.0, 36.0),
        state=(8.430145972, 0.198764901, -6.614175605, -0.888848863),
    ),
    "chaos far above the unit of the well": Formula("0.5*(x^2+y^2)+x^2*y^2-0.000001*x^6", energies=(60.0,)),
    "tori far above the unit of the well": Formula(
        _channels(8), state=(1.0116785783628948, 0.0, -0.07331004191035469, 1.2827574210080626)
    ),
    "Morse bond": Formula("0.5*x^2+200*(1-exp(-0.05*y))^2", energies=(312.5,), state=(0.1, 0.0, 0.0, 25.0)),
    "rational channel": Formula("0.5*x^2+0.5*y^2/(1+0.0001*y^2)", energies=(6000.0,)),
    "wells in an open channel": Formula("0.5*x^2-2/(1+(y-2)^2)-2/(1+(y+2)^2)", (0.0, 2.0), (0.2,), (0.1, 0.0, 0.0, 2.2)),
    "turn beyond an exit": Formula(
        "0.5*(1.2987*x^2+0.6412*y^2)+0.6056*x^3*y^3-0.8367*x^5*y^1",
        state=(0.16503073210843036, 0.5481251595317982, 0.005591749495613022, -2.440416258234151),
    ),
    "bent well with an exit inside its bend": Formula(
        "0.5*(x-0.0625*y^2)^2-0.375*(x-0.0625*y^2)^3+0.0078125*y^2", state=(0.0, 0.0, 0.05, 0.513)
    ),
    "periodic orbit through the bottom": Formula(
        "0.5*(0.6984*x^2+1.0459*y^2)+0.9621*y^3-1.4327*x*y^3-1.4081*x^2*y^2", energies=(0.38933533872666604,)
    ),
    "large constant": Formula("1e7+0.0001*(0.5*(x^2+y^2)+0.05*x^3-x^2*y^2)"),
    "meridional plane": Formula("0.5*log(x^2+y^2/0.81)+0.02/x^2", (0.2, 0.0)),
    "sum of exponentials": Formula("exp(6*x+7*y)+exp(6*x-7*y)+exp(-12*x)-3"),
    "flat axes": Formula("x^2*y^2*exp(-x^2-y^2)"),
    "closed well": Formula("x^2+y^2"),
}
"""Formulas that were once answered wrongly or refused for a wrong reason, with the energies and a start."""
