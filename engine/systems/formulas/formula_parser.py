"""Parser of potentials in common notation: "½(x² + y²) − x²y²", "0.5*(x^2+y^2) - x^2*y^2", "−1/√(x² + y² + c²) + x² exp(−y²)".

The text is parsed by recursive descent and expanded with exact fractions as far as it is a polynomial; it is never evaluated as
code. The grammar is:

    formula  := ["V" ["(x, y)"] "="] sum
    sum      := product {sign product}
    product  := factor {("*" | "/") factor | power}    "1/2 x" is ½ x; a power without "*" must not begin with a number
    factor   := {sign} power
    power    := base [exponent]
    exponent := superscript | ("^" | "**") {sign} (number | letter | superscript | "(" sum ")")    from −12 to 12
    base     := number | letter | "x" | "y" | "r" | "(" sum ")" | function "(" sum ")" | "√" base    r = √(x² + y²)
    function := "exp" | "log" | "ln" | "sin" | "cos" | "sqrt"

A letter, with or without one digit, is a parameter whose value is substituted: "a", "B", "k1", "α". Clauses can follow, see
`engine.systems.formulas.outcome_clauses`.
"""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial

from engine.expressions.exact_polynomials import RING, TooLargeError, exact_constant, exact_terms
from engine.expressions.nodes import Expression
from engine.expressions.polynomials import Powers
from engine.expressions.text import monomial
from engine.foundations.validation import checked_number, checks_types
from engine.systems.forms.polynomial_form import COEFFICIENT_RANGE, MOST_TERMS
from engine.systems.formulas.formula_tokens import (
    ALLOWED,
    BASE_KINDS,
    FROM_SUPERSCRIPT,
    OPERATORS,
    SIGNS,
    FormulaError,
    Token,
    read_number,
    tokenize,
)
from engine.systems.formulas.formula_values import (
    LARGEST_EXPONENT,
    NAMES,
    FormulaValue,
    add,
    constant_of,
    divide,
    negate,
    raise_to,
    times,
)
from engine.systems.formulas.formula_writer import by_degree, write_formula
from engine.systems.formulas.outcome_clauses import Part, split_clauses
from engine.systems.potential import Potential

LONGEST_TEXT = 500
"""Largest number of characters of a formula."""

DEEPEST_NESTING = 50
"""Largest depth of nested brackets, or of roots of roots, in a formula."""

LARGEST_VALUE = COEFFICIENT_RANGE[1]
"""Largest magnitude of the value of a letter; unlike a coefficient, it may be 0."""

MOST_LETTERS = 8
"""Largest number of different letters of a formula."""


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
          except e, t, E and V are allowed. "px", "py", "vx" and "vy" are refused;
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
    The potential. A polynomial is expanded exactly, with each coefficient rounded once and the terms sorted by degree; a constant
    term is kept.

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
    if len(text) > LONGEST_TEXT:
        raise FormulaError(LONGEST_TEXT, f"the text has {len(text)} characters; at most {LONGEST_TEXT} characters are allowed")
    values, clauses = _exact_values(text, parameters or {}), split_clauses(text)
    value = _Parser(clauses.formula, values).parse()
    if isinstance(value, Expression):
        potential = Potential(name or "", value)
        # Check the size of the derivatives, which all further steps need.
        if (problem := potential.form.limits_refusal()) is not None:
            raise FormulaError(0, problem)
    else:
        expanded = exact_terms(value)
        _check_expanded(expanded)
        terms = tuple((i, j, float(expanded[i, j])) for i, j in sorted(expanded, key=by_degree))
        potential = Potential(name or "", terms)
    number_of = partial(_number_of, values=values)
    ends = [clause.evaluate(number_of) for clause in clauses.ends]
    title = name or write_formula(potential)
    potential = Potential(title, potential.form, ends=ends, mass=clauses.find_mass(number_of))
    if clauses.well is not None:
        potential = potential.at_minimum(*map(number_of, clauses.well))
    return replace(potential, exit_names=clauses.exits) if clauses.exits else potential


def formula_letters(text: str) -> tuple[str, ...]:
    """Return the letters of a formula and its clauses in the order of the text; FormulaError for an unknown character."""
    letters: dict[str, int] = {}
    clauses = split_clauses(text)
    for part in (Part(clauses.formula, 0), *clauses.numbers):
        for token in tokenize(part.text):
            if token.kind == "letter":
                letters.setdefault(token.text, part.position + token.position)
    if len(letters) > MOST_LETTERS:
        problem = f"the formula has {len(letters)} letters for coefficients; at most {MOST_LETTERS} are allowed"
        raise FormulaError(list(letters.values())[MOST_LETTERS], problem)
    return tuple(letters)


def _number_of(part: Part, values: Mapping[str, Fraction]) -> float:
    """Return the value of a number in a clause; FormulaError if the text is not a number."""
    try:
        number = constant_of(_Parser(part.text, values).parse())
    except FormulaError as error:
        raise FormulaError(part.position + error.position, error.problem) from None
    if number is None:
        raise FormulaError(part.position, "a place, a radius or a mass must be a number, without x and y")
    return float(number)


def checked_letter_value(name: str, value: float) -> float:
    """Return the value of a letter as a float; ValueError if it is not finite or too large."""
    number = checked_number(name, value)
    if abs(number) > LARGEST_VALUE:
        raise ValueError(f"{name}={value}: must be between {-LARGEST_VALUE:g} and {LARGEST_VALUE:g}")
    return number


def _exact_values(text: str, parameters: Mapping[str, float]) -> dict[str, Fraction]:
    letters = formula_letters(text)
    for name in parameters:
        if name not in letters:
            legal = f"its letters are {', '.join(letters)}" if letters else "it has no letters"
            raise ValueError(f"parameters: {reprlib.repr(name)} is not a letter of the formula; {legal}")
    return {name: Fraction(repr(checked_letter_value(name, value))) for name, value in parameters.items()}


def _check_expanded(expanded: Mapping[Powers, Fraction]) -> None:
    if not any(i + j for i, j in expanded):
        raise FormulaError(0, "the expanded formula has neither x nor y; a potential must depend on at least one of them")
    if len(expanded) > MOST_TERMS:
        raise FormulaError(0, f"the expanded formula has {len(expanded)} terms; at most {MOST_TERMS} are allowed")
    low, high = COEFFICIENT_RANGE
    for (i, j), c in expanded.items():
        if not low <= abs(c) <= high:
            problem = f"the coefficient of {monomial(i, j) or '1'} must be between {low:g} and {high:g} in magnitude"
            raise FormulaError(0, problem)


# Kinds of tokens that are numbers.
_NUMBER_KINDS = ("number", "fraction")


def _is_r(token: Token) -> bool:
    return token.kind == "name" and token.text == "r"


class _Parser:
    """Recursive descent over the tokens of a text. Each `_parse_…` method handles one rule of the grammar."""

    def __init__(self, text: str, values: Mapping[str, Fraction]) -> None:
        self.tokens = tokenize(text)
        self.values = values
        self.index = 0
        self.depth = 0

    @property
    def token(self) -> Token:
        return self.tokens[self.index]

    def parse(self) -> FormulaValue:
        value = self._parse_sum()
        if self.token.kind != "end":
            raise self._unexpected_token()
        return value

    def _parse_sum(self) -> FormulaValue:
        value = self._parse_product()
        while self.token.kind == "sign":
            sign = self._next_token()
            right = self._parse_product()
            value = self._apply(sign, add, value, negate(right) if SIGNS[sign.text] == "-" else right)
        return value

    def _parse_product(self) -> FormulaValue:
        value = self._parse_factor()
        while self.token.kind in ("operator", *BASE_KINDS):
            # Without an operator, the first token belongs to the right factor.
            first_token, previous_token = self.token, self.tokens[self.index - 1]
            if first_token.kind == "operator":
                self._next_token()
            elif first_token.kind in _NUMBER_KINDS:
                place = f"{first_token.text} directly after {previous_token.text}"
                raise FormulaError(first_token.position, f"{place}: write * for a product, ^ for a power, as in 2x or x^2")
            right = self._parse_factor()
            is_division = OPERATORS.get(first_token.text) == "/"
            if is_division and constant_of(right) == 0:
                raise FormulaError(first_token.position, "the divisor must not be 0")
            value = self._apply(first_token, divide if is_division else times, value, right)
        return value

    def _parse_factor(self) -> FormulaValue:
        is_negative = self._parse_signs()
        value = self._parse_power()
        return negate(value) if is_negative else value

    def _parse_signs(self) -> bool:
        """Return whether the number of minus signs that follow is odd."""
        is_negative = False
        while self.token.kind == "sign":
            is_negative ^= SIGNS[self._next_token().text] == "-"
        return is_negative

    def _parse_power(self) -> FormulaValue:
        """Parse a base and its exponent. r^n is (x² + y²)^(n/2): even powers of r are polynomials."""
        first_token = self.token
        base = self._parse_base()
        exponent = self._parse_exponent()
        if _is_r(first_token):
            exponent = (1 if exponent is None else exponent) * Fraction(1, 2)
        return base if exponent is None else self._apply(first_token, raise_to, base, exponent)

    def _parse_exponent(self) -> Fraction | None:
        if self.token.kind not in ("power", "superscript"):
            return None
        mark = self._next_token()
        if mark.kind == "power":
            position = self.token.position
            exponent = self._parse_number_of_exponent()
        else:
            position = mark.position
            exponent = Fraction(mark.text.translate(FROM_SUPERSCRIPT))
        if abs(exponent) > LARGEST_EXPONENT:
            raise FormulaError(position, f"an exponent must be a number from {-LARGEST_EXPONENT} to {LARGEST_EXPONENT}")
        if self.token.kind in ("power", "superscript"):
            raise FormulaError(self.token.position, "a power of a power needs brackets, as in (x^2)^3")
        return exponent

    def _parse_number_of_exponent(self) -> Fraction:
        is_negative, token = self._parse_signs(), self.token
        if token.kind not in (*_NUMBER_KINDS, "letter", "open", "superscript"):
            raise FormulaError(token.position, f"an exponent must be a number from {-LARGEST_EXPONENT} to {LARGEST_EXPONENT}")
        if token.kind == "superscript":
            value: FormulaValue = exact_constant(Fraction(self._next_token().text.translate(FROM_SUPERSCRIPT)))
        else:
            value = self._parse_base()
        exponent = constant_of(value)
        if exponent is None:
            raise FormulaError(token.position, "an exponent must be a number, without x and y")
        return -exponent if is_negative else exponent

    def _parse_base(self) -> FormulaValue:
        token = self.token
        if token.kind not in BASE_KINDS:
            raise self._unexpected_token()
        self._next_token()
        if token.kind == "open":
            return self._parse_brackets(token)
        if token.kind in ("function", "root"):
            return self._parse_function(token)
        if token.kind != "name":
            return exact_constant(self.values.get(token.text, Fraction(1)) if token.kind == "letter" else read_number(token))
        x, y = RING.gens()
        # The value of r is r², see `_parse_power`.
        return {"x": x, "y": y, "r": x * x + y * y}[token.text]

    def _parse_function(self, token: Token) -> FormulaValue:
        """Parse the argument of a function, in brackets, or of √, which can be any base."""
        if token.kind == "root":
            first_token = self.token
            argument = self._parse_nested(token, self._parse_base) if first_token.kind == "root" else self._parse_base()
            if _is_r(first_token):
                argument = self._apply(token, raise_to, argument, Fraction(1, 2))
        else:
            if self.token.kind != "open":
                raise FormulaError(self.token.position, f"{token.text} needs its argument in brackets, as in {token.text}(x)")
            argument = self._parse_brackets(self._next_token())
        return self._apply(token, NAMES["sqrt" if token.kind == "root" else token.text], argument)

    def _parse_brackets(self, opening: Token) -> FormulaValue:
        value = self._parse_nested(opening, self._parse_sum)
        if self.token.kind == "end":
            raise FormulaError(opening.position, "this bracket is not closed")
        if self.token.kind != "close":
            raise self._unexpected_token()
        self._next_token()
        return value

    def _parse_nested(self, token: Token, parse: Callable[[], FormulaValue]) -> FormulaValue:
        """Parse the content of brackets, or of a root under a root."""
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise FormulaError(token.position, f"more than {DEEPEST_NESTING} nested brackets or roots")
        value = parse()
        self.depth -= 1
        return value

    @staticmethod
    def _apply[*Operands](token: Token, operation: Callable[[*Operands], FormulaValue], *operands: *Operands) -> FormulaValue:
        """Return the result of an operation; raise an error at the position of `token` if it is too large or not real."""
        try:
            return operation(*operands)
        except TooLargeError as error:
            raise FormulaError(token.position, f"the expanded formula is too large: {error}") from None
        except (ArithmeticError, ValueError):
            raise FormulaError(token.position, f"{token.text}: its value is not a finite real number") from None

    def _next_token(self) -> Token:
        """Return the current token and move to the next one; the end token stays current."""
        token = self.token
        self.index = min(self.index + 1, len(self.tokens) - 1)
        return token

    def _unexpected_token(self) -> FormulaError:
        if self.token.kind == "end":
            return FormulaError(self.token.position, "the formula ends where a number, x, y, r or a bracket is expected")
        return FormulaError(self.token.position, f"unexpected {self.token.text}; {ALLOWED}")
