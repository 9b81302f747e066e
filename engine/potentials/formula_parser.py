"""Parser of potentials in common notation: "½(x² + y²) − x²y²", "0.5*(x^2+y^2) - x^2*y^2", "r^2/2 - (x^5 - 10x^3y^2 + 5xy^4)/5".

The text is parsed by recursive descent and expanded with exact fractions; it is never evaluated as code. The grammar is:

    formula := ["V" ["(x, y)"] "="] sum
    sum     := [sign] product {sign product}
    product := factor {["*" | "/"] factor}            the divisor after "/" is a number; "1/2 x" is ½ x
    factor  := {sign} base ["^" digits | "**" digits | superscript]
    base    := number | "x" | "y" | "r" | "(" sum ")"  r² = x² + y², so r must have an even power
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from engine.polynomials import HIGHEST_DEGREE, ExactTerms, TooLargeError, exact_negative, exact_power, exact_product, exact_sum
from engine.potentials.potential import Potential

LONGEST_TEXT = 500
"""Largest number of characters of a formula."""

DEEPEST_NESTING = 50
"""Largest depth of nested brackets in a formula."""

MOST_TERMS = 60
"""Largest number of terms of a potential after expansion."""

COEFFICIENT_RANGE = (1e-9, 1e9)
"""Smallest and largest magnitude of a coefficient."""

# Limits that keep exact arithmetic fast.
_LARGEST_DECIMAL_EXPONENT = 99
_MOST_NUMBER_BITS = 700
# Coefficients are written as fractions up to this denominator, otherwise as decimals.
_LARGEST_DENOMINATOR = 1000

_FROM_SUPERSCRIPT = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_TO_SUPERSCRIPT = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_FRACTIONS = {
    "½": (1, 2),
    "⅓": (1, 3),
    "⅔": (2, 3),
    "¼": (1, 4),
    "¾": (3, 4),
    "⅕": (1, 5),
    "⅙": (1, 6),
    "⅛": (1, 8),
    "⅒": (1, 10),
}
_SIGNS = {"+": "+", "-": "-", "−": "-", "–": "-"}
_OPERATORS = {"*": "*", "·": "*", "×": "*", "⋅": "*", "∗": "*", "/": "/", "÷": "/", "∕": "/", "⁄": "/"}
_BASE_KINDS = ("number", "fraction", "name", "open")
_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[xyr])|(?P<superscript>[⁰¹²³⁴⁵⁶⁷⁸⁹]+)|(?P<power>\^|\*\*)"
    r"|(?P<fraction>[½⅓⅔¼¾⅕⅙⅛⅒])|(?P<sign>[+\-−–])|(?P<operator>[*·×⋅∗/÷∕⁄])|(?P<open>\()|(?P<close>\))"
)
_PREFIX = re.compile(r"\s*V\s*(?:\(\s*x\s*,\s*y\s*\)\s*)?=")
_ALLOWED = "allowed are numbers, x, y, r, + − * / ^ and round brackets"


class FormulaError(ValueError):
    """A formula that cannot be parsed; `position` is the index of the character at which parsing failed."""

    def __init__(self, position: int, problem: str) -> None:
        super().__init__(f"formula, character {position + 1}: {problem}")
        self.position = position


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    position: int


def parse_formula(text: str, name: str | None = None) -> Potential:
    """The potential given by a formula.

    Parameters
    ----------
    text
        A polynomial in x and y, at most 500 characters: numbers (2, 0.5, 1e-3, ½), x, y, r (r² = x² + y², even powers only),
        + − * / ^ ** and round brackets. "2x²y" is a product; "−", "·" and "×" are operators too; "V =" in front is ignored.
        Division is by numbers; "1/2 x" is half of x. Exponents are integers from 0 to 12.
    name
        Name of the potential; by default the formula as written by `write_formula`.

    Returns
    -------
    The potential, expanded exactly, with each coefficient rounded once and the terms sorted by degree; a constant term is kept.

    Raises
    ------
    ValueError
        A `FormulaError` with the position and the problem, if the text cannot be parsed, has more than 500 characters, more than
        50 nested brackets, a degree above 12, no term with x or y, more than 60 terms, or a coefficient whose magnitude is not
        between 1e-9 and 1e9.

    Examples
    --------
    >>> from engine import parse_formula
    >>> potential = parse_formula("½(x² + y²) + x²y − y³/3")
    >>> potential.channels, round(potential.escape_energy, 6)
    (3, 0.166667)
    """
    if len(text) > LONGEST_TEXT:
        raise FormulaError(LONGEST_TEXT, f"the text has {len(text)} characters; at most {LONGEST_TEXT} characters are allowed")
    expanded = _Parser(text).parse()
    _check_expanded(expanded)
    terms = tuple((i, j, float(expanded[i, j])) for i, j in sorted(expanded, key=_by_degree))
    potential = Potential(name or "", terms)
    return potential if name else Potential(write_formula(potential), terms)


def _check_expanded(expanded: ExactTerms) -> None:
    if not any(i + j for i, j in expanded):
        raise FormulaError(0, "the expanded formula has neither x nor y; a potential must depend on at least one of them")
    if len(expanded) > MOST_TERMS:
        raise FormulaError(0, f"the expanded formula has {len(expanded)} terms; at most {MOST_TERMS} are allowed")
    low, high = COEFFICIENT_RANGE
    for (i, j), c in expanded.items():
        if not low <= abs(c) <= high:
            problem = f"the coefficient of {_monomial(i, j) or '1'} must be between {low:g} and {high:g} in magnitude"
            raise FormulaError(0, problem)


def write_formula(potential: Potential, digits: int | None = None) -> str:
    """A potential as plain text, such as "x²/2 + y²/2 − x²y²".

    Parameters
    ----------
    potential
        The potential.
    digits
        Significant digits of the coefficients, so that `parse_formula` reads back each with a relative error of at most
        5·10^−digits; None for as many as it needs to read back exactly the same terms.

    Examples
    --------
    >>> from engine import parse_formula, write_formula
    >>> potential = parse_formula("½(x² + y²) − 0.123456789 x²y²")
    >>> write_formula(potential)
    'x²/2 + y²/2 − 0.123456789x²y²'
    >>> write_formula(potential, digits=4)
    'x²/2 + y²/2 − 10x²y²/81'
    """
    text = ""
    for i, j, c in sorted(potential.terms, key=_by_degree):
        sign = ("−" if c < 0 else "") if not text else (" − " if c < 0 else " + ")
        numerator, denominator = _ratio(abs(c), digits)
        monomial = _monomial(i, j)
        factor = "" if numerator == "1" and monomial else numerator
        text += f"{sign}{factor}{monomial}{f'/{denominator}' if denominator != '1' else ''}"
    return text or "0"


def _by_degree(term: tuple[int, int] | tuple[int, int, float]) -> tuple[int, int]:
    """Sort key of a term (i, j) or (i, j, c): by degree, then by the power of y."""
    i, j = term[:2]
    return i + j, j


def _ratio(size: float, digits: int | None) -> tuple[str, str]:
    """Numerator and denominator of a number, as an integer fraction if it is short, otherwise as decimals over 1."""
    fraction = Fraction(size).limit_denominator(_LARGEST_DENOMINATOR)
    if abs(float(fraction) - size) <= (0.0 if digits is None else 5.0 * 10.0**-digits * size):
        return str(fraction.numerator), str(fraction.denominator)
    return (repr(float(size)) if digits is None else f"{size:.{digits}g}"), "1"


def _monomial(i: int, j: int) -> str:
    letters = ((name, exponent) for name, exponent in (("x", i), ("y", j)) if exponent)
    return "".join(name + (str(exponent).translate(_TO_SUPERSCRIPT) if exponent > 1 else "") for name, exponent in letters)


class _Parser:
    """Recursive descent over the tokens of a text; each `_parse_…` method handles one rule of the grammar."""

    def __init__(self, text: str) -> None:
        self.tokens = _tokenize(text)
        self.index = 0
        self.depth = 0

    @property
    def token(self) -> _Token:
        return self.tokens[self.index]

    def parse(self) -> ExactTerms:
        value = self._parse_sum()
        if self.token.kind != "end":
            raise self._unexpected_token()
        return value

    def _parse_sum(self) -> ExactTerms:
        value = self._parse_product()
        while self.token.kind == "sign":
            sign = self._next_token()
            right = self._parse_product()
            value = self._bounded(sign, exact_sum, value, exact_negative(right) if _SIGNS[sign.text] == "-" else right)
        return value

    def _parse_product(self) -> ExactTerms:
        value = self._parse_factor()
        while self.token.kind in ("operator", *_BASE_KINDS):
            operator, before = self.token, self.tokens[self.index - 1]
            if operator.kind == "operator":
                self._next_token()
            elif operator.kind in ("number", "fraction"):
                problem = f"{operator.text} directly after {before.text}: write * for a product, ^ for a power, as in 2x or x^2"
                raise FormulaError(operator.position, problem)
            right = self._parse_factor()
            if _OPERATORS.get(operator.text) == "/":
                right = _reciprocal(operator, right)
            value = self._bounded(operator, exact_product, value, right)
        return value

    def _parse_factor(self) -> ExactTerms:
        negative = False
        while self.token.kind == "sign":
            negative ^= _SIGNS[self._next_token().text] == "-"
        value = self._parse_power()
        return exact_negative(value) if negative else value

    def _parse_power(self) -> ExactTerms:
        start = self.token
        value = self._parse_base()
        exponent = self._parse_exponent()
        if start.kind == "name" and start.text == "r":
            if exponent is None or exponent % 2:
                raise FormulaError(start.position, "r = √(x² + y²) must have an even power, as in r^2, to be a polynomial")
            exponent //= 2
        return value if exponent is None else self._bounded(start, exact_power, value, exponent)

    def _parse_exponent(self) -> int | None:
        if self.token.kind not in ("power", "superscript"):
            return None
        token = self._next_token()
        if token.kind == "power":
            token = self._next_token()
        digits = token.text.translate(_FROM_SUPERSCRIPT)
        if not re.fullmatch("[0-9]{1,3}", digits) or int(digits) > HIGHEST_DEGREE:
            raise FormulaError(token.position, f"an exponent must be an integer from 0 to {HIGHEST_DEGREE}, without brackets")
        if self.token.kind in ("power", "superscript"):
            raise FormulaError(self.token.position, "a power of a power needs brackets, as in (x^2)^3")
        return int(digits)

    def _parse_base(self) -> ExactTerms:
        if self.token.kind not in _BASE_KINDS:
            raise self._unexpected_token()
        token = self._next_token()
        if token.kind == "open":
            return self._parse_brackets(token)
        if token.kind == "number":
            return _number(token)
        if token.kind == "fraction":
            return {(0, 0): Fraction(*_FRACTIONS[token.text])}
        one = Fraction(1)
        # The power of r is halved, so its base is r².
        return {"x": {(1, 0): one}, "y": {(0, 1): one}, "r": {(2, 0): one, (0, 2): one}}[token.text]

    def _parse_brackets(self, opening: _Token) -> ExactTerms:
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise FormulaError(opening.position, f"more than {DEEPEST_NESTING} nested brackets")
        value = self._parse_sum()
        if self.token.kind == "end":
            raise FormulaError(opening.position, "this bracket is not closed")
        if self.token.kind != "close":
            raise self._unexpected_token()
        self._next_token()
        self.depth -= 1
        return value

    @staticmethod
    def _bounded[*Operands](token: _Token, operation: Callable[[*Operands], ExactTerms], *operands: *Operands) -> ExactTerms:
        """The result of an exact operation; if it is too large, an error at the position of `token`."""
        try:
            return operation(*operands)
        except TooLargeError as error:
            raise FormulaError(token.position, f"the expanded formula is too large: {error}") from None

    def _next_token(self) -> _Token:
        """Return the current token and move to the next one; the end token is never passed."""
        token = self.token
        self.index = min(self.index + 1, len(self.tokens) - 1)
        return token

    def _unexpected_token(self) -> FormulaError:
        if self.token.kind == "end":
            return FormulaError(self.token.position, "the formula ends where a number, x, y, r or a bracket is expected")
        return FormulaError(self.token.position, f"unexpected {self.token.text}; {_ALLOWED}")


def _tokenize(text: str) -> list[_Token]:
    prefix = _PREFIX.match(text)
    position = prefix.end() if prefix else 0
    tokens: list[_Token] = []
    while position < len(text):
        if text[position].isspace():
            position += 1
            continue
        match = _TOKEN.match(text, position)
        if match is None:
            raise FormulaError(position, f"{text[position]!r} is not understood; {_ALLOWED}")
        tokens.append(_Token(str(match.lastgroup), match.group(), position))
        position = match.end()
    return [*tokens, _Token("end", "", len(text))]


def _number(token: _Token) -> ExactTerms:
    exponent = re.search("[eE]([+-]?[0-9]+)$", token.text)
    if exponent and (len(exponent[1]) > 4 or abs(int(exponent[1])) > _LARGEST_DECIMAL_EXPONENT):
        raise FormulaError(token.position, f"a decimal exponent must be at most {_LARGEST_DECIMAL_EXPONENT} in magnitude")
    value = Fraction(token.text)
    if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MOST_NUMBER_BITS:
        raise FormulaError(token.position, "a number of more than 200 digits")
    return {(0, 0): value} if value else {}


def _reciprocal(operator: _Token, divisor: ExactTerms) -> ExactTerms:
    if set(divisor) != {(0, 0)}:
        raise FormulaError(operator.position, "the divisor must be a number other than 0")
    return {(0, 0): 1 / divisor[0, 0]}
