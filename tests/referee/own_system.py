"""Derive V, its gradient and its curvature, and heyoka's equations of motion, from the text of a formula with SymPy alone."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import heyoka as hy
import numpy as np
import sympy

from tests.referee.formulas import X, Y

DEVIATION = ("dx", "dy", "dpx", "dpy")


class OwnSystem:
    """V(x, y) of a formula, with coordinates that count from `origin`. It uses no code of the engine."""

    def __init__(self, expression: sympy.Expr, origin: tuple[float, float] = (0.0, 0.0)) -> None:
        moves = {each: each + sympy.Float(by, 17) for each, by in zip((X, Y), origin, strict=True) if by}
        self.expression = expression.subs(moves, simultaneous=True)
        self._value = _function(self.expression)

    @cached_property
    def _slopes(self) -> list[sympy.Expr]:
        return [sympy.diff(self.expression, each) for each in (X, Y)]

    @cached_property
    def _curvatures(self) -> list[sympy.Expr]:
        vx, vy = self._slopes
        return [sympy.diff(vx, X), sympy.diff(vx, Y), sympy.diff(vy, Y)]

    @cached_property
    def _numerical(self) -> list[Any]:
        return [_function(each) for each in (*self._slopes, *self._curvatures)]

    def value(self, x: Any, y: Any) -> np.ndarray:
        with np.errstate(all="ignore"):
            return self._value(x, y)

    def gradient(self, x: Any, y: Any) -> np.ndarray:
        with np.errstate(all="ignore"):
            return np.array([each(x, y) for each in self._numerical[:2]])

    def curvature(self, x: Any, y: Any) -> np.ndarray:
        """The second derivatives, of shape (2, 2, …)."""
        with np.errstate(all="ignore"):
            vxx, vxy, vyy = (each(x, y) for each in self._numerical[2:])
        return np.array([[vxx, vxy], [vxy, vyy]])

    def equations(self) -> list[tuple[Any, Any]]:
        """heyoka's equations of motion."""
        x, y, px, py = hy.make_vars("x", "y", "px", "py")
        vx, vy = (_in_heyoka(each) for each in self._slopes)
        return [(x, px), (y, py), (px, -vx), (py, -vy)]

    def variational_equations(self) -> list[tuple[Any, Any]]:
        """heyoka's equations of motion, and of one deviation vector."""
        dx, dy, dpx, dpy = hy.make_vars(*DEVIATION)
        vxx, vxy, vyy = (_in_heyoka(each) for each in self._curvatures)
        return [*self.equations(), (dx, dpx), (dy, dpy), (dpx, -vxx * dx - vxy * dy), (dpy, -vxy * dx - vyy * dy)]

    def is_symmetric(self, image: np.ndarray, size: float) -> bool:
        """Whether V is unchanged by a matrix (2, 2), to rounding, at random points within four times a size."""
        points = np.random.default_rng(3).uniform(-4.0 * size, 4.0 * size, (2, 200))
        value, other = self.value(*points), self.value(*(image @ points))
        scale = np.ptp(self.value(*(points / 8.0)))
        return bool(np.all(np.abs(value - other) <= 1e-12 * (scale + np.abs(value) + np.abs(other))))


def _function(expression: sympy.Expr) -> Any:
    function = sympy.lambdify((X, Y), expression, "numpy")
    return lambda x, y: function(np.asarray(x, float), np.asarray(y, float)) + 0.0 * np.asarray(x, float)


def _in_heyoka(expression: sympy.Expr) -> Any:
    """Return an expression of SymPy as one of heyoka. Integer powers are products, because the series of x**3 divides by x."""
    if not expression.free_symbols:
        return hy.expression(float(expression))
    if expression.is_Symbol:
        return hy.make_vars(expression.name)
    if expression.is_Pow:
        base, exponent = expression.as_base_exp()
        if exponent.is_Integer and exponent > 0:
            return math.prod([_in_heyoka(base)] * int(exponent), start=hy.expression(1.0))
        if not exponent.free_symbols:
            return _in_heyoka(base) ** float(exponent)
    parts = [_in_heyoka(part) for part in expression.args]
    if expression.is_Add:
        return sum(parts, start=hy.expression(0.0))
    if expression.is_Mul:
        return math.prod(parts, start=hy.expression(1.0))
    return getattr(hy, type(expression).__name__)(*parts)
