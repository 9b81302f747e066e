"""Potentials as plain text that the parser can read."""

from __future__ import annotations

from engine.expressions.text import join_signed, monomial_term, write_expression
from engine.foundations.validation import checked_count, checks_types
from engine.systems.forms.expression_form import ExpressionForm, Form
from engine.systems.formulas.outcome_clauses import write_clauses
from engine.systems.potential import Potential

# Number of significant digits that determine a double.
_MOST_DIGITS = 17


@checks_types(potential=Potential)
def write_formula(potential: Potential, digits: int | None = None) -> str:
    """Return a potential as plain text, such as "x²/2 + y²/2 − x²y²"; in a rotating frame, the effective potential.

    Parameters
    ----------
    potential
        The potential.
    digits
        Number of significant digits of the coefficients, 1 to 17: `parse_formula` reads each coefficient with a relative error
        of at most 5·10^−digits. None for all digits needed to read exactly the same terms. Short fractions are preferred.

    Examples
    --------
    >>> from escape_explorer import parse_formula, write_formula
    >>> potential = parse_formula("½(x² + y²) − 0.123456789 x²y²")
    >>> write_formula(potential)
    'x²/2 + y²/2 − 0.123456789x²y²'
    >>> write_formula(potential, digits=4)
    'x²/2 + y²/2 − 10x²y²/81'
    """
    if digits is not None:
        digits = checked_count("digits", digits, 1, _MOST_DIGITS)
    return write_form(potential.form, digits) + write_clauses(potential.ends, potential.exit_names, potential.mass)


def write_form(form: Form, digits: int | None = None) -> str:
    """Return a form as plain text, see `write_formula`."""
    if isinstance(form, ExpressionForm):
        return write_expression(form.expression, digits)
    terms = sorted(form.terms, key=by_degree)
    return join_signed([(c, monomial_term(i, j, abs(c), digits)) for i, j, c in terms]) or "0"


def by_degree(term: tuple[int, int] | tuple[int, int, float]) -> tuple[int, int]:
    """Return the sort key of a term (i, j) or (i, j, c): by degree, then by the power of y."""
    i, j = term[:2]
    return i + j, j
