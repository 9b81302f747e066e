"""Write the formulas of a system as MathML, derived from its potential."""

from __future__ import annotations

from html import escape
from xml.etree import ElementTree

from engine import Potential
from engine.expressions.nodes import Expression, from_terms
from engine.systems.forms.expression_form import Form
from plots.texts.mathml_elements import COEFFICIENT_DIGITS, digits, number, op, row, var, write_power
from plots.texts.mathml_expressions import signed_parts

# Words for operators and dots.
_SPOKEN_SIGNS = {"+": "plus", "−": "minus", "=": "equals", "∂": "partial", "˙": "dot", "¨": "double dot"}
# Words for exponents.
_POWERS = {"2": "squared", "3": "cubed"}
# Names of the integral, by whether the frame rotates.
_INTEGRALS = {False: "Energy integral", True: "Jacobi integral"}


def equations(potential: Potential) -> str:
    """Return an HTML list of Hamiltonian, potential, equations of motion, energy integral, escape energy and saddles."""
    rows = {
        **_hamiltonian(potential),
        "Effective potential" if potential.rotation else "Potential": [_potential(potential)],
        "Equations of motion": [_motion(axis, potential) for axis in ("x", "y")],
        _INTEGRALS[bool(potential.rotation)]: [
            _energy(potential, 0.5 * potential.mass, *(write_power(_above(axis, "˙"), 2) for axis in "xy")) + op("=") + var("h")
        ],
        **_exits(potential),
    }
    style = "font-size:17px;margin:2px 0 8px 12px;display:flex;flex-wrap:wrap;align-items:center;gap:4px 28px;overflow-x:auto"
    body = "".join(f"<dt>{name}</dt><dd style='{style}'>{''.join(map(_math, formulas))}</dd>" for name, formulas in rows.items())
    return f"<dl style='margin:0;font-size:13px;color:inherit'>{body}</dl>"


def potential_formula(potential: Potential, shown: int = COEFFICIENT_DIGITS) -> str:
    """Return V(x, y) = … as text with one MathML element for each term, because browsers do not break long MathML elements.

    Coefficients that are decimal numbers have `shown` significant digits.
    """
    first, *others = _signed_terms(potential.form, shown)
    # By default, a sign at the start of an element has the space of a unary sign.
    terms = [first, *(term.replace("<mo>", "<mo form='infix'>", 1) for term in others)]
    # The signs have space of their own.
    elements = "<wbr>".join(f"<math aria-hidden='true'>{part}</math>" for part in (_at_point(potential) + op("="), *terms))
    return f"<span role='math' aria-label='{_spoken(_potential(potential, shown))}'>{elements}</span>"


def _potential(potential: Potential, shown: int = COEFFICIENT_DIGITS) -> str:
    return _at_point(potential) + op("=") + _sum(potential.form, shown)


def potential_symbol(potential: Potential) -> str:
    """Return V, or Φ for the effective potential of a rotating frame."""
    return "Φ" if potential.rotation else "V"


def _at_point(potential: Potential) -> str:
    return var(potential_symbol(potential)) + _ARGUMENTS


def _hamiltonian(potential: Potential) -> dict[str, list[str]]:
    """Return H in momenta; nothing in a rotating frame, where the Jacobi integral in velocities is enough."""
    if potential.rotation:
        return {}
    squares = _momentum_squared("x"), _momentum_squared("y")
    return {"Hamiltonian": [var("H") + op("=") + _energy(potential, 0.5 / potential.mass, *squares)]}


def _exits(potential: Potential) -> dict[str, list[str]]:
    """Return the escape energy, and the saddles in the order of the channels; empty without channels."""
    if not potential.channels:
        return {}
    escape_energy = f"<msub>{var('h')}<mtext>esc</mtext></msub>" + op("=") + number(potential.escape_energy)
    points = (op("(") + number(x) + op(",") + number(y) + op(")") for x, y in potential.saddles)
    saddles = [f"<mtext>exit {k}:\u00a0</mtext>{point}" for k, point in enumerate(points, start=1)]
    return {"Escape energy": [escape_energy], "Saddles (x, y) of the potential": saddles}


def _motion(axis: str, potential: Potential) -> str:
    """Return mass × acceleration = −∂V/∂axis, with the derivative written out, or with the Coriolis term in a rotating frame."""
    force = potential.form.force("xy".index(axis))
    partial = f"<mfrac>{row(op('∂') + var(potential_symbol(potential)))}{row(op('∂') + var(axis))}</mfrac>"
    mass = "" if potential.mass == 1.0 else number(potential.mass)
    acceleration = mass + _above(axis, "¨") + op("=") + row(_coriolis(axis, potential) + op("−") + partial)
    return acceleration if potential.rotation else acceleration + op("=") + _sum(force)


def _coriolis(axis: str, potential: Potential) -> str:
    """Return 2mΩẏ or −2mΩẋ; empty in a frame that does not rotate."""
    if not potential.rotation:
        return ""
    rate = number(2.0 * potential.mass * abs(potential.rotation))
    is_negative = (potential.rotation > 0.0) == (axis == "y")
    return (op("−") if is_negative else "") + rate + _above("y" if axis == "x" else "x", "˙")


def _energy(potential: Potential, factor: float, first: str, second: str) -> str:
    """Return factor (first + second) + V(x, y)."""
    squares = op("(") + first + op("+") + second + op(")")
    return (number(factor) if factor != 1.0 else "") + squares + op("+") + _at_point(potential)


def _sum(form: Form, shown: int = COEFFICIENT_DIGITS) -> str:
    """Return a formula with its terms in order."""
    return row("".join(_signed_terms(form, shown)))


def _signed_terms(form: Form, shown: int) -> list[str]:
    """Return the terms with their signs. The first term has no plus sign."""
    definition = form.definition
    expression = definition if isinstance(definition, Expression) else from_terms({(i, j): c for i, j, c in definition})
    first, *others = signed_parts(expression, shown)
    return [first.removeprefix(op("+")), *others]


def _math(formula: str) -> str:
    words = _spoken(formula)
    return f'<math display="block" alttext="{words}" aria-label="{words}">{formula}</math>'


def _spoken(formula: str) -> str:
    """Return a formula in words, escaped for attributes."""
    return escape(_words(ElementTree.fromstring(f"<math>{formula}</math>")))


def _words(node: ElementTree.Element) -> str:
    """Return the text of a formula for screen readers."""
    parts = [_words(child) for child in node]
    if node.tag == "mfrac":
        return "/".join(parts) if all(part.isdecimal() for part in parts) else " over ".join(parts)
    if node.tag == "msup":
        return f"{parts[0]} {_POWERS.get(parts[1], f'to the power of {parts[1]}')}"
    if node.tag in ("msub", "msubsup"):
        return " ".join((parts[0], "sub", parts[1], *(_POWERS[power] for power in parts[2:])))
    text = (node.text or "").strip().replace("√", " square root of ").strip()
    return " ".join([_SPOKEN_SIGNS.get(text, text), *parts]).strip()


def _above(name: str, dots: str) -> str:
    return f"<mover accent='true'>{var(name)}{op(dots)}</mover>"


def _momentum_squared(axis: str) -> str:
    return f"<msubsup>{var('p')}{var(axis)}{digits(2)}</msubsup>"


_ARGUMENTS = "<mo stretchy='false'>(</mo>" + var("x") + op(",") + var("y") + "<mo stretchy='false'>)</mo>"
