"""Make random and hostile formulas of every kind that a visitor can type, as parameters of links."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping

from engine.systems.formulas.formula_grammar import DEEPEST_NESTING
from engine.systems.formulas.formula_parser import LONGEST_TEXT

Link = dict[str, str]
"""Parameters of a link, without its case."""

_WELLS = ("½(x² + y²)", "r²/2", "−1/√(1 + x² + y²)", "½ log(1 + x² + 2y²)", "−cos(x) − cos(y)", "(1 + r²)^0.7")
_FUNCTIONS = ("sqrt", "√", "log", "exp", "sin", "cos")
_DIGITS = "0123456789"
_CHARACTERS = "xyr²³½−+·*/^()√ ;=,.eEVαωΩ٣９🜁\u202e\u0301\0<>&'\"`{}$\\"
_NUMBERS = ("1e9", "1e-9", "1e308", "1e-320", "1e999", "0.1", "3", "−7", "12", "1/3", "½", "0")


def random_link(choice: random.Random) -> Link:
    """Return the parameters of a link with a formula of a random kind."""
    return choice.choice(list(KINDS.values()))(choice)


def _well(choice: random.Random) -> str:
    return choice.choice(_WELLS)


def _number(choice: random.Random) -> str:
    return choice.choice([f"{choice.uniform(0.05, 3.0):.3f}", str(choice.randint(1, 9))])


def _monomial(choice: random.Random, highest: int = 6) -> str:
    return f"{_number(choice)}*x^{choice.randint(0, highest)}*y^{choice.randint(0, highest)}"


def _wrapped(choice: random.Random, depth: int, inner: str, functions: tuple[str, ...] = _FUNCTIONS) -> str:
    """Return `depth` nested functions around `inner`, some of them with an addend."""
    for _ in range(depth):
        added = f"{_number(choice)}+" if choice.random() < 0.5 else ""
        inner = f"{choice.choice(functions)}({added}{inner})"
    return inner


def _polynomial(choice: random.Random) -> Link:
    terms = choice.randint(1, 12)
    return {"V": f"{_well(choice)}" + "".join(f"{choice.choice('+−')}{_monomial(choice)}" for _ in range(terms))}


def _nested_roots_and_logarithms(choice: random.Random) -> Link:
    inner = _wrapped(choice, choice.randint(1, 12), choice.choice(["x^2+y^2", "1+x", "x*y+2"]), ("sqrt", "√", "log"))
    return {"V": f"{_well(choice)} − {_number(choice)}{choice.choice(['', ' x²'])}*{inner}"}


def _deeply_nested(choice: random.Random) -> Link:
    depth = choice.choice([30, 30, DEEPEST_NESTING - 1, DEEPEST_NESTING, DEEPEST_NESTING + 1])
    return {"V": f"x²+y²−{_wrapped(choice, depth, 'x', (choice.choice(_FUNCTIONS),) if choice.random() < 0.5 else _FUNCTIONS)}"}


def _large_arguments(choice: random.Random) -> Link:
    factor = choice.choice([f"{10 ** choice.randint(1, 9)}", "1e9", "99999999"])
    function, inner = choice.choice(["sin", "cos", "exp", "log"]), choice.choice(["x", "x*y", "x^12", "r", "x+y"])
    return {"V": f"{_well(choice)} + {_number(choice)}*{function}({factor}*{inner})"}


def _sum_of_poles(choice: random.Random) -> Link:
    poles = choice.randint(1, 60)
    power = choice.choice(["", "^2", "^12"])
    terms = (
        f"{choice.choice('+-')}1/(x-{k}){power}" if choice.random() < 0.7 else f"-1/sqrt((x-{k})^2+y^2)" for k in range(poles)
    )
    return {"V": ("x²+y²" + "".join(terms))[: choice.choice([LONGEST_TEXT, LONGEST_TEXT, 2000])]}


def _products(choice: random.Random) -> Link:
    factors = choice.randint(2, 40)
    forms = ("(1+x)", "(x-y)", "(2-x^2)", "(1+x^2+y^2)", "(x+y)^12", "sin(x)", "(1-r)", "exp(y)")
    chosen = choice.sample(forms, 2) if choice.random() < 0.5 else forms
    return {"V": f"{_well(choice)} − " + "*".join(choice.choice(chosen) for _ in range(factors))}


def _with_letters(choice: random.Random) -> Link:
    letters = choice.sample(["a", "b", "k1", "α", "Q", "m", "n", "β2", "c", "d"], choice.randint(1, 9))
    terms = "".join(f" {choice.choice('+−')} {letter} {_monomial(choice, 4)}" for letter in letters)
    values = ",".join(f"{letter}:{choice.choice([*_NUMBERS, _number(choice), 'nan', ''])}" for letter in letters)
    power = f" − x²^{letters[0]}" if choice.random() < 0.3 else ""
    return {"V": _well(choice) + terms + power, "letters": values}


def _moved_to_a_well(choice: random.Random) -> Link:
    shapes = ("x + x² + y² + x³", "(x−1)² + y² − (x−1)² y²", "cos(x) + cos(y)", "1/(x-3)+1/(x+3)+y²", "x⁴ − x² + y²")
    place = ", ".join(choice.choice([*_NUMBERS, _number(choice), "a", "x"]) for _ in range(choice.choice([2, 2, 2, 3])))
    return {"V": f"{choice.choice(shapes)} + {_monomial(choice, 3)}; well ({place})"}


def _with_bodies(choice: random.Random) -> Link:
    count = choice.randint(1, 9)
    places = [(round(choice.uniform(-3.0, 3.0), 2), round(choice.uniform(-3.0, 3.0), 2)) for _ in range(count)]
    terms = "".join(f"−{_number(choice)}/√((x−({x}))²+(y−({y}))²)" for x, y in places[:4])
    radii = (choice.choice(["0.001", "0.1", "1e-300", "−1", "2"]) for _ in places)
    bodies = "".join(f"; centre B{n} ({x}, {y}) {radius}" for n, ((x, y), radius) in enumerate(zip(places, radii, strict=True)))
    escape = choice.choice(
        [
            "",
            "; escape 10",
            "; escape 1e9",
            "; escape 0",
            "; escape 10 exits 4",
            "; escape 9 exits 2.5",
            "; escape 9 exits 3 from 1e9",
        ]
    )
    return {"V": f"{terms}{bodies}{escape}"[:LONGEST_TEXT], "rotation": choice.choice(["0", "1", "0.3", "1e9", "-2"])}


def _in_rotating_frame(choice: random.Random) -> Link:
    made = choice.choice([_polynomial, _nested_roots_and_logarithms, _with_letters])(choice)
    return made | {"rotation": choice.choice([*_NUMBERS, "0.5", "−0.5", "nan"])}


def _along_a_parameter(choice: random.Random) -> Link:
    low, high = (choice.choice([*_NUMBERS, _number(choice)]) for _ in range(2))
    name = choice.choice(["a", "a", "a", "omega_1", "rotation", "epsilon", "b"])
    term = choice.choice(["a x²y", "x³/a", "sin(a x)", "√(1 + a x²)", "x^a", "a x²y²"])
    return {"V": f"{_well(choice)} − {term}", "plane": f"x,{name}={low}:{high}", "letters": f"a:{_number(choice)}"}


def _with_ranges(choice: random.Random) -> Link:
    names = ("omega_1", "omega_2", "epsilon", "rotation")
    return _polynomial(choice) | {name: choice.choice([*_NUMBERS, _number(choice)]) for name in names}


def _long_numbers(choice: random.Random) -> Link:
    digits = "".join(choice.choices(_DIGITS, k=choice.choice([20, 100, 300, 450])))
    number = choice.choice(
        [digits, f"0.{digits}", f"1/{digits}", f"{digits}e-{len(digits)}", f"{digits[:200]}/{digits[200:] or 7}"]
    )
    return {"V": f"{number}*x² + y²{choice.choice(['', ' − x²y²', f'−x^{number}'])}"}


def _any_characters(choice: random.Random) -> Link:
    return {"V": "".join(choice.choices(_CHARACTERS, k=choice.choice([1, 5, 40, 200, LONGEST_TEXT])))}


def _damaged(choice: random.Random) -> Link:
    """Return a formula of another kind in which some characters are exchanged, left out or added."""
    link = choice.choice([_polynomial, _with_letters, _moved_to_a_well, _with_bodies])(choice)
    text = list(link["V"])
    for _ in range(choice.randint(1, 4)):
        place = choice.randrange(len(text))
        text[place : place + choice.randint(0, 2)] = choice.choices(_CHARACTERS, k=choice.randint(0, 2))
        text = text or ["x"]
    return link | {"V": "".join(text)}


def _functions_of_all(choice: random.Random) -> Link:
    """Return a short formula whose products and derivatives are many."""
    inner = choice.choice(["x^2*y", "x*y", "1+x^2+y^2", "x+2y"])
    terms = [f"{choice.choice(_FUNCTIONS)}({_number(choice)}+{_number(choice)}*{inner})" for _ in range(choice.randint(2, 30))]
    return {"V": f"{_well(choice)} {choice.choice('+−')} " + choice.choice("+*").join(terms)}


KINDS: Mapping[str, Callable[[random.Random], Link]] = {
    "polynomial": _polynomial,
    "nested roots and logarithms": _nested_roots_and_logarithms,
    "deeply nested": _deeply_nested,
    "large arguments": _large_arguments,
    "sum of poles": _sum_of_poles,
    "products": _products,
    "letters": _with_letters,
    "moved to a well": _moved_to_a_well,
    "bodies": _with_bodies,
    "rotating frame": _in_rotating_frame,
    "along a parameter": _along_a_parameter,
    "parameters": _with_ranges,
    "long numbers": _long_numbers,
    "any characters": _any_characters,
    "damaged": _damaged,
    "functions of all": _functions_of_all,
}
"""Makers of the parameters of a link, by kind."""
