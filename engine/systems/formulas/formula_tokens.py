"""Tokens of formulas: numbers, names, letters for parameters, operators and brackets."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from fractions import Fraction

# Largest magnitude of a decimal exponent, which keeps exact arithmetic fast.
_LARGEST_DECIMAL_EXPONENT = 99
# Largest number of bits of a numerator or denominator, about 210 digits, which keeps exact arithmetic fast.
_MOST_NUMBER_BITS = 700

_FROM_SUPERSCRIPT = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_FROM_SUBSCRIPT = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
# Plain signs and operators by the characters that stand for them.
SIGNS = {"+": "+", "-": "-", "−": "-", "–": "-"}
OPERATORS = {"*": "*", "·": "*", "×": "*", "⋅": "*", "∗": "*", "/": "/", "÷": "/", "∕": "/", "⁄": "/"}
BASE_KINDS = ("number", "fraction", "name", "letter", "open", "function", "root")
"""Kinds of tokens with which a factor can begin."""
FUNCTIONS = ("sin", "cos", "exp", "log", "ln", "sqrt")
"""Names of functions."""
# A token. The kind of a token is the name of its group.
_TOKEN = re.compile(
    f"(?P<function>{'|'.join(FUNCTIONS)})"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    "|(?P<name>[xyr])"
    "|(?P<letter>[A-DF-UW-Za-df-qs-wzΑ-Ωα-ω][0-9₀-₉]?)"
    "|(?P<superscript>⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
    r"|(?P<power>\^|\*\*)"
    "|(?P<fraction>[½⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅐⅛⅜⅝⅞⅑⅒])"
    r"|(?P<sign>[+\-−–])"
    "|(?P<operator>[*·×⋅∗/÷∕⁄])"
    "|(?P<root>√)"
    r"|(?P<open>\()"
    r"|(?P<close>\))"
)
# A word directly before a bracket.
_WORD_OF_CALL = re.compile(r"(?<![A-Za-zΑ-Ωα-ω])[A-Za-zΑ-Ωα-ω]+[0-9₀-₉]?(?=\()")
# Names that would otherwise be read as letters or products, such as momenta, velocities, a third coordinate and time.
_UNKNOWN = re.compile("sinh|cosh|tanh?|abs|pi|[pv][xyz]|z(?![0-9₀-₉])|t")
# What to write instead of names and characters that are not understood.
_REMEDIES = {
    "sinh": "write (exp(u) − exp(−u))/2 for sinh(u)",
    "cosh": "write (exp(u) + exp(−u))/2 for cosh(u)",
    "tanh": "write 1 − 2/(exp(2u) + 1) for tanh(u)",
    "tan": "write sin(u)/cos(u) for tan(u)",
    "abs": "write √(u²) for abs(u)",
    "|": "write √(u²) for |u|",
    "pi": "write 3.141592653589793",
    "e": "write exp(u) for a power of e",
    "E": "write exp(u) for a power of e",
    ",": "write decimals with a point, as in 0.5",
}
# "V =" or "V(x, y) =" in front of a formula.
_PREFIX = re.compile(r"\s*V\s*(?:\(\s*x\s*,\s*y\s*\)\s*)?=")
ALLOWED = (
    "allowed are numbers, x, y, r, letters except e, t and z for coefficients, + − * / ^ √, exp, log, sin, cos and round brackets"
)
"""The elements of a formula."""


class FormulaError(ValueError):
    """A formula that cannot be parsed; `position` is the index of the character at which parsing failed."""

    def __init__(self, position: int, problem: str) -> None:
        super().__init__(f"formula, character {position + 1}: {problem}")
        self.position, self.problem = position, problem

    def __reduce__(self) -> tuple[type[FormulaError], tuple[int, str]]:
        """Support pickling, because errors are passed between processes."""
        return FormulaError, (self.position, self.problem)


@dataclass(frozen=True)
class Token:
    """A piece of a formula.

    Attributes
    ----------
    kind
        Name of the group of the pattern of tokens, such as "number" or "letter", or "end".
    text
        The characters. A letter has a plain digit in place of a subscript.
    position
        Index of the first character in the text.
    """

    kind: str
    text: str
    position: int


def tokenize(text: str) -> list[Token]:
    """Split a text into tokens, and add a token of kind "end"; FormulaError for an unknown character or function."""
    prefix = _PREFIX.match(text)
    position = prefix.end() if prefix else 0
    tokens: list[Token] = []
    while position < len(text):
        if text[position].isspace():
            position += 1
            continue
        unknown = _UNKNOWN.match(text, position)
        match = _TOKEN.match(text, position) if unknown is None else None
        if match is None:
            found = unknown.group() if unknown is not None else text[position]
            raise FormulaError(position, f"'{found}' is not understood; {_REMEDIES.get(found, ALLOWED)}")
        token_text = match.group()
        if match.lastgroup == "letter":
            token_text = token_text.translate(_FROM_SUBSCRIPT)
        tokens.append(Token(str(match.lastgroup), token_text, position))
        position = match.end()
    _check_calls(text, tokens)
    return [*tokens, Token("end", "", len(text))]


def _check_calls(text: str, tokens: list[Token]) -> None:
    """Raise FormulaError for a word of several letters that stands directly before a bracket and is no function."""
    for match in _WORD_OF_CALL.finditer(text):
        kinds = [token.kind for token in tokens if match.start() <= token.position < match.end()]
        if kinds.count("letter") > 1 and kinds[-1] != "function":
            problem = f"'{match.group()}' is not a function; functions are {', '.join(FUNCTIONS)}; a product needs * or spaces"
            raise FormulaError(match.start(), problem)


def read_number(token: Token) -> Fraction:
    """Return the exact value of a number, a fraction or a superscript; FormulaError if a number has too many digits."""
    if token.kind == "superscript":
        return Fraction(token.text.translate(_FROM_SUPERSCRIPT))
    if token.kind == "fraction":
        # The denominators of these characters are 2 to 10.
        return Fraction(unicodedata.numeric(token.text)).limit_denominator(10)
    exponent = re.search("[eE]([+-]?[0-9]+)$", token.text)
    if exponent and (len(exponent[1]) > 4 or abs(int(exponent[1])) > _LARGEST_DECIMAL_EXPONENT):
        raise FormulaError(token.position, f"a decimal exponent must be at most {_LARGEST_DECIMAL_EXPONENT} in magnitude")
    value = Fraction(token.text)
    if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MOST_NUMBER_BITS:
        raise FormulaError(token.position, "a number of more than 200 digits")
    return value
