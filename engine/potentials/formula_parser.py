"""Potentials as people type them: "½(x² + y²) − x²y²", "0.5*(x^2+y^2) - x^2*y^2", "r^2/2 - (x^5 - 10x^3y^2 + 5xy^4)/5".

A grammar of our own, read by recursive descent; nothing is ever evaluated as a program. The text is expanded in exact fractions.

    formula := ["V" ["(x, y)"] "="] sum
    sum     := [sign] product {sign product}
    product := factor {["*" | "/"] factor}            what stands behind "/" is a number; "1/2 x" is ½ x
    factor  := {sign} base ["^" digits | "**" digits | superscript]
    base    := number | "x" | "y" | "r" | "(" sum ")"  r² = x² + y², so r has an even power
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

from engine.polynomials import HIGHEST_DEGREE, Exact, TooLargeError, add, negative, power, product
from engine.potentials.potential import Potential

LONGEST_TEXT = 500
"""Characters a formula may have."""

DEEPEST_NESTING = 50
"""Brackets within brackets a formula may have."""

MOST_TERMS = 60
"""Terms a potential may have once it is expanded."""

COEFFICIENTS = (1e-9, 1e9)
"""Smallest and largest size of a coefficient."""

# A decimal exponent of three digits is no number that anyone means, and a long one takes long to write out.
_LARGEST_DECIMAL_EXPONENT = 99
_LARGEST_DENOMINATOR = 1000

_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_VULGAR = {"½": (1, 2), "⅓": (1, 3), "⅔": (2, 3), "¼": (1, 4), "¾": (3, 4), "⅕": (1, 5), "⅙": (1, 6), "⅛": (1, 8), "⅒": (1, 10)}
_SIGNS = {"+": "+", "-": "-", "−": "-", "–": "-"}
_TIMES = {"*": "*", "·": "*", "×": "*", "⋅": "*", "∗": "*", "/": "/", "÷": "/", "∕": "/", "⁄": "/"}
_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[xyr])|(?P<superscript>[⁰¹²³⁴⁵⁶⁷⁸⁹]+)|(?P<power>\^|\*\*)"
    r"|(?P<fraction>[½⅓⅔¼¾⅕⅙⅛⅒])|(?P<sign>[+\-−–])|(?P<times>[*·×⋅∗/÷∕⁄])|(?P<open>\()|(?P<close>\))"
)
_PREFIX = re.compile(r"\s*V\s*(?:\(\s*x\s*,\s*y\s*\)\s*)?=")
_LEGAL = "legal are numbers, x, y, r, + − * / ^ and round brackets"


class FormulaError(ValueError):
    """A formula that cannot be read: `position` is the number of the character, from 0, at which reading stopped."""

    def __init__(self, position: int, problem: str) -> None:
        super().__init__(f"formula, character {position + 1}: {problem}")
        self.position = position


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    position: int


def parse_formula(text: str, name: str | None = None) -> Potential:
    """The potential that a formula stands for.

    Parameters
    ----------
    text
        A polynomial in x and y, at most 500 characters: numbers (2, 0.5, 1e-3, ½), x, y, r (r² = x² + y², even powers only),
        + − * / ^ ** and round brackets, written as people write: "2x²y" is a product, "−", "·" and "×" are read, "V =" may
        stand before it. Division is by numbers; "1/2 x" is half of x. Powers are whole numbers from 0 to 12.
    name
        What to call it; the formula itself, as `write_formula` writes it, where none is given.

    Returns
    -------
    The potential, expanded exactly, each coefficient rounded once, its terms in order of degree; a constant term stays.

    Raises
    ------
    ValueError
        A `FormulaError` that says where and why, when the text cannot be read, is longer than 500 characters, nested more than 50
        deep, of degree above 12, or comes to no term, to more than 60, or to coefficients of a size outside 1e-9 … 1e9.
    """
    if len(text) > LONGEST_TEXT:
        raise FormulaError(LONGEST_TEXT, f"the text has {len(text)} characters; at most {LONGEST_TEXT} are read")
    expanded = _Reader(text).read()
    if not any(i + j for i, j in expanded):
        raise FormulaError(0, "neither x nor y is left once it is expanded; a potential depends on at least one of them")
    if len(expanded) > MOST_TERMS:
        raise FormulaError(0, f"it expands to {len(expanded)} terms; at most {MOST_TERMS} are possible")
    low, high = COEFFICIENTS
    for (i, j), c in expanded.items():
        if not low <= abs(c) <= high:
            raise FormulaError(0, f"the coefficient of {_monomial(i, j) or '1'} must be between {low:g} and {high:g} in size")
    terms = tuple((i, j, float(expanded[i, j])) for i, j in sorted(expanded, key=_order))
    potential = Potential(name or "", terms)
    return potential if name else Potential(write_formula(potential), terms)


def write_formula(potential: Potential) -> str:
    """A potential in plain text, as in "x²/2 + y²/2 − x²y²"; `parse_formula` reads it back to the very same terms."""
    text = ""
    for i, j, c in sorted(potential.terms, key=lambda term: _order(term[:2])):
        sign = ("−" if c < 0 else "") if not text else (" − " if c < 0 else " + ")
        numerator, denominator = _ratio(abs(c))
        monomial = _monomial(i, j)
        factor = "" if numerator == "1" and monomial else numerator
        text += f"{sign}{factor}{monomial}{f'/{denominator}' if denominator != '1' else ''}"
    return text or "0"


def typeset(potential: Potential) -> str:
    """A potential as MathML, made of nothing but numbers, x, y and signs, for a browser to set."""
    parts: list[str] = []
    for i, j, c in sorted(potential.terms, key=lambda term: _order(term[:2])):
        if parts or c < 0:
            parts.append(f"<mo>{'−' if c < 0 else '+'}</mo>")
        numerator, denominator = _ratio(abs(c))
        letters = "".join(_letter(name, exponent) for name, exponent in (("x", i), ("y", j)))
        number = f"<mn>{numerator}</mn>" if denominator == "1" else f"<mfrac><mn>{numerator}</mn><mn>{denominator}</mn></mfrac>"
        parts.append(letters if letters and (numerator, denominator) == ("1", "1") else number + letters)
    return f"<math><mi>V</mi><mo>=</mo>{''.join(parts) or '<mn>0</mn>'}</math>"


def _order(powers: tuple[int, ...]) -> tuple[int, int]:
    """By degree, and within a degree from x to y."""
    i, j = powers[:2]
    return i + j, j


def _ratio(size: float) -> tuple[str, str]:
    """Numerator and denominator of a number: whole where its fraction is short, else its shortest decimals over 1."""
    exact = Fraction(size).limit_denominator(_LARGEST_DENOMINATOR)
    if float(exact) == size:
        return str(exact.numerator), str(exact.denominator)
    return repr(float(size)), "1"


def _monomial(i: int, j: int) -> str:
    raised = ((name, exponent) for name, exponent in (("x", i), ("y", j)) if exponent)
    return "".join(name + (str(exponent).translate(_RAISED) if exponent > 1 else "") for name, exponent in raised)


def _letter(name: str, exponent: int) -> str:
    if exponent < 2:
        return f"<mi>{name}</mi>" * exponent
    return f"<msup><mi>{name}</mi><mn>{exponent}</mn></msup>"


class _Reader:
    """Recursive descent over the tokens of one text; every method reads one rule of the grammar."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.tokens = _tokens(text)
        self.at = 0
        self.depth = 0

    def read(self) -> Exact:
        value = self._sum()
        if self._kind() != "end":
            raise self._unexpected()
        return value

    def _sum(self) -> Exact:
        value = self._product()
        while self._kind() == "sign":
            sign = self._take()
            right = self._product()
            value = self._bounded(sign, lambda a=value, b=right, s=sign: add(a, negative(b) if _SIGNS[s.text] == "-" else b))
        return value

    def _product(self) -> Exact:
        value = self._factor()
        while True:
            kind, before = self._kind(), self.tokens[self.at - 1]
            here = self.tokens[self.at]
            if kind == "times":
                self._take()
            elif kind not in ("number", "fraction", "name", "open"):
                return value
            elif kind in ("number", "fraction"):
                problem = f"{here.text} directly after {before.text}: write * for a product, ^ for a power, as in 2x or x^2"
                raise FormulaError(here.position, problem)
            right = self._factor()
            if kind == "times" and _TIMES[here.text] == "/":
                if not right or set(right) != {(0, 0)}:
                    raise FormulaError(here.position, "what stands behind / must be a number other than 0")
                right = {(0, 0): 1 / right[0, 0]}
            value = self._bounded(here, lambda a=value, b=right: product(a, b))

    def _factor(self) -> Exact:
        minus = False
        while self._kind() == "sign":
            minus ^= _SIGNS[self._take().text] == "-"
        value = self._raised()
        return negative(value) if minus else value

    def _raised(self) -> Exact:
        start = self.tokens[self.at]
        value = self._base()
        exponent = self._exponent()
        if start.kind == "name" and start.text == "r":
            if exponent is None or exponent % 2:
                raise FormulaError(start.position, "r = √(x² + y²) needs an even power, as in r^2: only those are polynomials")
            exponent //= 2
        if exponent is None:
            return value
        return self._bounded(start, lambda: power(value, exponent))

    def _exponent(self) -> int | None:
        kind = self._kind()
        if kind not in ("power", "superscript"):
            return None
        token = self._take()
        if kind == "power":
            token = self._take()
        digits = token.text.translate(_SUPERSCRIPTS)
        if not re.fullmatch("[0-9]{1,3}", digits) or int(digits) > HIGHEST_DEGREE:
            raise FormulaError(token.position, f"a power must be a whole number from 0 to {HIGHEST_DEGREE}, without brackets")
        if self._kind() in ("power", "superscript"):
            raise FormulaError(self.tokens[self.at].position, "a power of a power: put brackets around what is raised")
        return int(digits)

    def _base(self) -> Exact:
        token = self.tokens[self.at]
        if token.kind not in ("number", "fraction", "name", "open"):
            raise self._unexpected()
        self._take()
        if token.kind == "number":
            return _number(token)
        if token.kind == "fraction":
            return {(0, 0): Fraction(*_VULGAR[token.text])}
        if token.kind == "name":
            one = Fraction(1)
            return {"x": {(1, 0): one}, "y": {(0, 1): one}, "r": {(2, 0): one, (0, 2): one}}[token.text]
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise FormulaError(token.position, f"more than {DEEPEST_NESTING} brackets within each other")
        value = self._sum()
        if self._kind() != "close":
            raise FormulaError(token.position, "this bracket is never closed") if self._kind() == "end" else self._unexpected()
        self._take()
        self.depth -= 1
        return value

    def _bounded(self, token: _Token, work: object) -> Exact:
        """What `work` returns; where that is too large, an error at the token that asked for it."""
        assert callable(work)
        try:
            value: Exact = work()
        except TooLargeError as error:
            raise FormulaError(token.position, f"this comes to something {error}") from None
        return value

    def _kind(self) -> str:
        return self.tokens[self.at].kind

    def _take(self) -> _Token:
        token = self.tokens[self.at]
        self.at = min(self.at + 1, len(self.tokens) - 1)
        return token

    def _unexpected(self) -> FormulaError:
        token = self.tokens[self.at]
        if token.kind == "end":
            return FormulaError(token.position, "the formula ends where a number, x, y, r or a bracket must stand")
        return FormulaError(token.position, f"{token.text} cannot stand here; {_LEGAL}")


def _tokens(text: str) -> list[_Token]:
    prefix = _PREFIX.match(text)
    at = prefix.end() if prefix else 0
    tokens: list[_Token] = []
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        match = _TOKEN.match(text, at)
        if match is None:
            raise FormulaError(at, f"{text[at]!r} is not understood; {_LEGAL}")
        tokens.append(_Token(str(match.lastgroup), match.group(), at))
        at = match.end()
    return [*tokens, _Token("end", "", len(text))]


def _number(token: _Token) -> Exact:
    exponent = re.search("[eE]([+-]?[0-9]+)$", token.text)
    if exponent and (len(exponent[1]) > 4 or abs(int(exponent[1])) > _LARGEST_DECIMAL_EXPONENT):
        raise FormulaError(token.position, f"a decimal exponent must be at most {_LARGEST_DECIMAL_EXPONENT} in size")
    value = Fraction(token.text)
    if value.numerator.bit_length() > 700 or value.denominator.bit_length() > 700:
        raise FormulaError(token.position, "a number of more than 200 digits")
    return {(0, 0): value} if value else {}
