"""The highest energy up to which the well at the origin is shown to be closed: its Hill region there is bounded.

Below its lowest exit saddle, a well can still be open, along a valley that leads to infinity without a saddle. The proof is that
of `hill_component`. At the energy of the saddle itself, the region touches the region beyond, so barriers along the ridges of V
at the saddles keep them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from engine.expressions.nodes import Expression, from_terms
from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import hessian_matrix
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.landscape.hill_component import Barrier, ComponentSearch, Extent

HIGHEST_TRIED = 4.0**16
"""Largest height above the bottom at which a well without exits is tested, in units of energy."""

# Step of the difference across a ridge, in units of the distance of the saddle from the origin.
_RIDGE_STEP = 1e-3
# Half the length of a barrier along a ridge, in the same unit, to try in turn.
_HALF_LENGTHS = 2.0 ** -np.arange(0.5, 8.5, 0.5)
# Ends of the parts of half a barrier, as shares of its length. Nearer to the saddle, the ridge rises because its curvature
# there is positive.
_PARTS = 1.1 ** np.arange(-60.0, 1.0)
# Energies above the bottom at which a well without exits is tested, in units of energy, as powers of 4.
_POWERS = (-3.0, 1.0, 5.0, 9.0, 13.0, 16.0)
# Lower powers, to try in turn if the well is open at all of these: the core of a deep well can be much smaller than the unit of
# length.
_LOW_POWERS = (-7.0, -11.0, -15.0)
# Number of bisections between an energy at which the well is closed and one at which it may be open.
_BISECTIONS = 7


def ridge_bend(form: Form, saddle: np.ndarray, outward: np.ndarray) -> float:
    """Return a of the ridge u = a q² near a saddle, with u along the unit vector `outward` and q across it. On it, V_u = 0.

    a = −V_uqq/(2 V_uu). A central difference suffices for V_uqq, because any a near the exact value gives a ridge that rises.
    """
    step = _RIDGE_STEP * float(np.hypot(*saddle)) * np.array([-outward[1], outward[0]])
    sides = np.array([saddle - step, saddle + step])
    slopes = outward @ np.array(np.broadcast_arrays(*form.gradient(*sides.T)))
    curvature = outward @ hessian_matrix(form, *saddle) @ outward
    return float(-0.5 * slopes.sum() / (step @ step) / curvature)


def component_search(form: Form, length: float) -> ComponentSearch:
    """Return the search for components of the Hill region of a form, with its unit of length."""
    expression: Expression = from_terms(form.coefficients) if isinstance(form, PolynomialForm) else form.expression
    return ComponentSearch(expression, length)


def find_closed_energy(
    search: ComponentSearch, form: Form, saddles: np.ndarray, outward: np.ndarray, bottom: float, unit: float
) -> float:
    """Return the highest energy, of those tried, up to which the well at the origin is shown to be closed; −∞ without any.

    Parameters
    ----------
    search
        The search for components of `form`.
    form
        The function V.
    saddles, outward
        The exit saddles of the well and the unit vectors along their unstable directions, away from the well, (n, 2) each.
    bottom
        V at the bottom of the well.
    unit
        The unit of energy, in which energies are tried if there are no exit saddles.
    """
    if not len(saddles):
        return _find_without_saddles(search, bottom, unit)
    escape_energy = float(np.min(form.value(*saddles.T)))
    if search.examine(escape_energy, _ridge_barriers(search, form, saddles, outward, escape_energy)) is Extent.BOUNDED:
        return escape_energy
    return _bisect(search, lambda share: bottom + share * (escape_energy - bottom), 0.0, 1.0)


def _find_without_saddles(search: ComponentSearch, bottom: float, unit: float) -> float:
    """Return the result of `find_closed_energy` for a well without exits."""

    def energy_at(power: float) -> float:
        return bottom + unit * 4.0**power

    count = next((k for k, power in enumerate(_POWERS) if not _is_closed(search, energy_at(power))), len(_POWERS))
    if count == len(_POWERS):
        return energy_at(_POWERS[-1])
    low = _POWERS[count - 1] if count else next((p for p in _LOW_POWERS if _is_closed(search, energy_at(p))), None)
    if low is None:
        return -np.inf
    high = min(power for power in (*_LOW_POWERS, *_POWERS) if power > low)
    return max(energy_at(low), _bisect(search, energy_at, low, high))


def _bisect(search: ComponentSearch, energy_at: Callable[[float], float], low: float, high: float) -> float:
    """Return the highest energy between two at which the well is closed, of those that bisection tries; −∞ without any."""
    highest = -np.inf
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        if _is_closed(search, energy_at(middle)):
            low, highest = middle, energy_at(middle)
        else:
            high = middle
    return float(highest)


def _is_closed(search: ComponentSearch, energy: float) -> bool:
    return search.examine(energy) is Extent.BOUNDED


def _ridge_barriers(
    search: ComponentSearch, form: Form, saddles: np.ndarray, outward: np.ndarray, energy: float
) -> Sequence[Barrier]:
    """Return a barrier along the ridge at each saddle, as long as V on it is shown to exceed an energy; none where this fails."""
    barriers = []
    for saddle, direction in zip(saddles, outward, strict=True):
        bend = ridge_bend(form, saddle, direction)
        for half_length in (np.hypot(*saddle) * _HALF_LENGTHS).tolist():
            if _rises(search, saddle, direction, bend, half_length, energy):
                barriers.append(Barrier.parabola(saddle, direction, bend, half_length))
                break
    return barriers


def _rises(
    search: ComponentSearch, saddle: np.ndarray, outward: np.ndarray, bend: float, half_length: float, energy: float
) -> bool:
    """Return whether V exceeds an energy on boxes that cover a ridge up to `half_length` from a saddle on both sides."""
    across = np.array([-outward[1], outward[0]])
    for side in (-1.0, 1.0):
        q = (side * half_length * _PARTS)[:, None]
        ends = saddle + bend * q**2 * outward + q * across
        # The distance of a parabola from its chord.
        margin = 0.25 * abs(bend) * np.diff(q, axis=0) ** 2
        first, last = np.minimum(ends[:-1], ends[1:]) - margin, np.maximum(ends[:-1], ends[1:]) + margin
        if not (search.bounds(first, last)[0] > energy).all():
            return False
    return True
