"""Functions written as straight-line programs agree with values of 40 digits in any lane of a vector."""

from __future__ import annotations

from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from numba import njit

from engine.integrator.jit.llvm_emitter import straight_line, table_reader
from engine.integrator.source.elementary import cos_of, exp_of, log_of, power_of, sin_of
from engine.integrator.source.straight_line import StraightLine, Value

mpmath.mp.dps = 40
WIDE = (-500.0, 500.0)


def compiled(function: Callable[[Value], Value]) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function for arrays."""
    program = StraightLine("_f", {})
    program.results = [function(program.input("u")).index]
    call, read = straight_line(lambda: program), table_reader(0)

    @njit(error_model="numpy", fastmath={"contract"})
    def run(table, u):
        out = np.empty_like(u)
        entries = read(table)
        for i in range(u.shape[0]):
            (out[i],) = call(entries, u[i])
        return out

    return lambda u: run(np.empty(0), u)


@pytest.mark.parametrize(
    ("function", "exact", "low", "high", "ulps"),
    [
        (exp_of, mpmath.exp, *WIDE, 2),
        (log_of, mpmath.log, 0.9, 1.1, 3),
        (log_of, mpmath.log, 1e-300, 1e300, 3),
        (lambda u: power_of(u, -1.5), lambda u: u ** mpmath.mpf(-1.5), 1e-3, 10.0, 5),
        (lambda u: power_of(u, 5.0), lambda u: u**5, -2.0, 2.0, 5),
        (lambda u: power_of(u, -3.0), lambda u: u**-3, -2.0, -0.1, 5),
        (lambda u: power_of(u, 0.7), lambda u: u ** mpmath.mpf(0.7), 0.05, 20.0, 8),
    ],
)
def test_relative_errors_are_a_few_units_in_the_last_place(
    function: Callable[[Value], Value], exact: Callable[[mpmath.mpf], mpmath.mpf], low: float, high: float, ulps: float
) -> None:
    u = np.random.default_rng(1).uniform(low, high, 400)
    for place, value in zip(u.tolist(), compiled(function)(u).tolist(), strict=True):
        expected = exact(mpmath.mpf(place))
        assert abs(mpmath.mpf(value) / expected - 1) < ulps * 2.0**-52


@pytest.mark.parametrize(("function", "exact"), [(sin_of, mpmath.sin), (cos_of, mpmath.cos)])
@pytest.mark.parametrize("reach", [1.0, 9e5])
def test_errors_of_sine_and_cosine_are_below_one_unit_of_one(
    function: Callable[[Value], Value], exact: Callable[[mpmath.mpf], mpmath.mpf], reach: float
) -> None:
    u = np.random.default_rng(2).uniform(-reach, reach, 400)
    for place, value in zip(u.tolist(), compiled(function)(u).tolist(), strict=True):
        assert abs(mpmath.mpf(value) - exact(mpmath.mpf(place))) < 2.0**-52


@pytest.mark.parametrize(("function", "u"), [(log_of, -1.0), (log_of, 0.0), (lambda u: power_of(u, -0.5), -1.0), (sin_of, 2e6)])
def test_arguments_outside_the_domain_give_nan(function: Callable[[Value], Value], u: float) -> None:
    assert np.isnan(compiled(function)(np.array([u]))[0])


@pytest.mark.parametrize("function", [exp_of, log_of, sin_of, lambda u: power_of(u, -2.5)])
def test_results_do_not_depend_on_the_lane(function: Callable[[Value], Value]) -> None:
    run, u = compiled(function), np.random.default_rng(3).uniform(0.1, 4.0, 67)
    np.testing.assert_array_equal(run(u), [run(u[k : k + 1])[0] for k in range(len(u))])
