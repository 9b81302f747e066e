"""The grammar of formulas, parsed by recursive descent.

The grammar is:

    formula  := ["V" ["(x, y)"] "="] sum
    sum      := product {sign product}
    product  := factor {("*" | "/") factor | power}    "1/2 x" is ½ x; a power without "*" must not begin with a number
    factor   := {sign} power
    power    := base [exponent]
    exponent := superscript | ("^" | "**") {sign} (number | letter | superscript | "(" sum ")")    from −12 to 12
    base     := number | letter | "x" | "y" | "r" | "(" sum ")" | function "(" sum ")" | "√" base    r = √(x² + y²)
    function := "exp" | "log" | "ln" | "sin" | "cos" | "sqrt"

A letter, with or without one digit, is a parameter whose value is substituted: "a", "B", "k1", "α".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from engine.expressions.exact_polynomials import RING, TooLargeError, exact_constant
from engine.systems.formulas.formula_tokens import (
    ALLOWED,
    BASE_KINDS,
    OPERATORS,
    SIGNS,
    FormulaError,
    Token,
    read_number,
    tokenize,
)
from engine.systems.formulas.formula_values import (
    NAMED_FUNCTIONS,
    FormulaValue,
    add,
    constant_of,
    divide,
    negate,
    raise_to,
    times,
)

LARGEST_EXPONENT = 12
"""Largest magnitude of an exponent in a formula."""

DEEPEST_NESTING = 50
"""Largest depth of nested brackets, or of roots of roots, in a formula."""

# Kinds of tokens that are numbers.
_NUMBER_KINDS = ("number", "fraction")


def _is_r(token: Token) -> bool:
    return token.kind == "name" and token.text == "r"


class Parser:
    """Recursive descent over the tokens of a text.

    Parameters
    ----------
    text
        A formula without clauses.
    values
        Values of letters by name; a letter without a value stands for 1.
    """

    def __init__(self, text: str, values: Mapping[str, Fraction]) -> None:
        self.tokens = tokenize(text)
        self.values = values
        self.index = 0
        self.depth = 0

    @property
    def token(self) -> Token:
        """The next token."""
        return self.tokens[self.index]

    def parse(self) -> FormulaValue:
        """Return the value of the whole text; FormulaError if the text is not a formula."""
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
            # Without an operator, the first token belongs to the factor on the right.
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
            exponent = self._parse_exponent_value()
        else:
            position = mark.position
            exponent = read_number(mark)
        if abs(exponent) > LARGEST_EXPONENT:
            raise FormulaError(position, f"an exponent must be a number from −{LARGEST_EXPONENT} to {LARGEST_EXPONENT}")
        if self.token.kind in ("power", "superscript"):
            raise FormulaError(self.token.position, "a power of a power needs brackets, as in (x^2)^3")
        return exponent

    def _parse_exponent_value(self) -> Fraction:
        is_negative, token = self._parse_signs(), self.token
        if token.kind not in (*_NUMBER_KINDS, "letter", "open", "superscript"):
            raise FormulaError(token.position, f"an exponent must be a number from −{LARGEST_EXPONENT} to {LARGEST_EXPONENT}")
        if token.kind == "superscript":
            value: FormulaValue = exact_constant(read_number(self._next_token()))
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
        if token.kind == "letter":
            return exact_constant(self.values.get(token.text, Fraction(1)))
        if token.kind != "name":
            return exact_constant(read_number(token))
        x, y = RING.gens()
        # The value of r is r², see `_parse_power`.
        return {"x": x, "y": y, "r": x * x + y * y}[token.text]

    def _parse_function(self, token: Token) -> FormulaValue:
        """Parse the argument, in brackets for a function and any base for √, and apply the function."""
        if token.kind == "root":
            first_token = self.token
            argument = self._parse_nested(token, self._parse_base) if first_token.kind == "root" else self._parse_base()
            if _is_r(first_token):
                argument = self._apply(token, raise_to, argument, Fraction(1, 2))
        else:
            if self.token.kind != "open":
                raise FormulaError(self.token.position, f"{token.text} needs its argument in brackets, as in {token.text}(x)")
            argument = self._parse_brackets(self._next_token())
        return self._apply(token, NAMED_FUNCTIONS["sqrt" if token.kind == "root" else token.text], argument)

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
        """Return the result of an operation; FormulaError at the position of `token` if the result is too large or not real."""
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
