"""Parts of an expression whose zeros are its singularities, or zeros of its slope."""

from __future__ import annotations

from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum, as_sum, as_terms, factors_of
from engine.expressions.polynomials import degree


def singular_bases(expression: Expression) -> tuple[Expression, ...]:
    """Return the divisors, and the arguments of roots and logarithms, each once."""
    return tuple(dict.fromkeys(_bases(expression)))


def _bases(expression: Expression) -> list[Expression]:
    """Return the result of `singular_bases` with repetitions."""
    match expression:
        case Sum(_, terms):
            return [base for part, _ in terms for base in _bases(part)]
        case Function(name, argument):
            return [*([argument] if name == "log" else []), *_bases(argument)]
        case Product(factors):
            singular = [base for base, exponent in factors if exponent < 0.0 or exponent != int(exponent)]
            return [*singular, *(inner for base, _ in factors for inner in _bases(base))]
    return []


def repeated_factors(expression: Expression) -> tuple[Expression, ...]:
    """Return bases of powers above 1 that are factors of an expression less its constant. Where a base is 0, the slope is 0."""
    terms = as_sum(expression).terms
    return tuple(base for base, exponent in factors_of(terms[0][0]) if exponent > 1.0) if len(terms) == 1 else ()


def has_central_part(expression: Expression) -> bool:
    """Return whether one of the singular bases is a multiple of x² + y²."""
    return any(_is_central(base) for base in singular_bases(expression))


def _is_central(base: Expression) -> bool:
    """Return whether an expression is c (x² + y²)."""
    terms = as_terms(base)
    if terms is None:
        return False
    c = terms.get((2, 0), 0.0)
    return terms == {(2, 0): c, (0, 2): c}


def oblique_gradients(expression: Expression) -> tuple[tuple[float, float], ...]:
    """Return the gradients (a, b), each once, of the bases of powers and arguments of functions a x + b y + c with a, b ≠ 0."""
    polynomials = (as_terms(part) for part in dict.fromkeys(_inner_parts(expression)))
    gradients = ((terms.get((1, 0), 0.0), terms.get((0, 1), 0.0)) for terms in polynomials if terms and degree(terms) == 1)
    return tuple(dict.fromkeys((a, b) for a, b in gradients if a and b))


def _inner_parts(expression: Expression) -> list[Expression]:
    """Return the bases of powers and the arguments of functions, at all depths."""
    match expression:
        case Sum(_, terms):
            return [inner for part, _ in terms for inner in _inner_parts(part)]
        case Function(_, argument):
            return [argument, *_inner_parts(argument)]
        case Product(factors):
            return [part for base, _ in factors if not isinstance(base, Coordinate) for part in (base, *_inner_parts(base))]
    return []
