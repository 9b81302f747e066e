"""Parts of an expression whose zeros are singularities of it."""

from __future__ import annotations

from engine.expressions.nodes import Expression, Function, Product, Sum


def singular_bases(expression: Expression) -> tuple[Expression, ...]:
    """What is divided by, and of which a root or a logarithm is taken, each once."""
    return tuple(dict.fromkeys(_bases(expression)))


def _bases(expression: Expression) -> list[Expression]:
    match expression:
        case Sum(_, terms):
            return [base for part, _ in terms for base in _bases(part)]
        case Function(name, argument):
            return [*([argument] if name == "log" else []), *_bases(argument)]
        case Product(factors):
            singular = [base for base, exponent in factors if exponent < 0.0 or exponent != int(exponent)]
            return [*singular, *(inner for base, _ in factors for inner in _bases(base))]
    return []
