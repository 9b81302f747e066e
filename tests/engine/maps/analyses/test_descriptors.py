"""Lagrangian descriptors equal independent integrals along the orbits, in any frame, units and direction of time."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from threading import Event
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    Execution,
    Fate,
    MapSpec,
    ParameterAxis,
    Plane,
    Potential,
    Slice,
    System,
    TimeDirection,
    compute_lagrangian_descriptor,
    compute_map,
)
from engine.exits.exit_rows import exit_curves
from engine.foundations.execution import SerialExecutor
from engine.maps.analyses.descriptors import DEFAULT_DURATION
from engine.propagation.speed_integrals import integrate_speed
from engine.slices.axes import Coordinate

# Relative error to which chaotic orbits, and orbits close to a body, amplify rounding errors within the default time.
ACCURACY = 1e-9
SPECS = {
    "II": MapSpec(CASES["II"], Plane.X_PX, 0.24, (5, 5), t_max=100.0),
    "energies": MapSpec(CASES["I"], Plane.X_H, (0.1, 0.3), (4, 5), t_max=100.0),
    "in a rotating frame": MapSpec(POTENTIALS["Star cluster"], Plane.X_PX, -1.75, (5, 5), t_max=20.0),
    "with a body": MapSpec(POTENTIALS["Hill"], Plane.X_PX, -2.0, (5, 5), t_max=20.0),
}


def integrate(potential: Potential, state: np.ndarray, end: float, power: float) -> float:
    """Return ∫ |v|^p dt from 0 to `end`, which may be negative. SciPy integrates the orbit with the integral as a component."""

    def rates(_t: float, values: np.ndarray) -> list[float]:
        x, y, vx, vy, _ = values
        slope_x, slope_y = potential.gradient(x, y)
        turn = 2.0 * potential.rotation
        return [vx, vy, turn * vy - slope_x, -turn * vx - slope_y, (vx * vx + vy * vy) ** (0.5 * power)]

    return abs(float(solve_ivp(rates, (0.0, end), [*state, 0.0], method="DOP853", rtol=1e-13, atol=1e-15).y[4, -1]))


@pytest.mark.parametrize(("direction", "power"), [(TimeDirection.FORWARD, 0.5), (TimeDirection.BACKWARD, 1.0)])
@pytest.mark.parametrize("name", SPECS)
def test_the_integral_until_the_exit_agrees_with_another_method(name: str, direction: TimeDirection, power: float) -> None:
    spec = SPECS[name]
    frame = compute_map(spec)
    found = compute_lagrangian_descriptor(frame, power=power, direction=direction)
    sign = 1.0 if direction is TimeDirection.FORWARD else -1.0
    ends = compute_map(replace(spec, backward=sign < 0.0))
    duration = DEFAULT_DURATION * spec.potential.units.time
    durations = np.where(ends.fate > 0, np.minimum(ends.escape_time, duration), duration)
    states = spec.start_states(*frame.coordinates(np.arange(frame.fate.size))).reshape(*frame.fate.shape, 4)
    interior = frame.interior
    expected = [
        integrate(spec.potential, states[at], sign * durations[at], power) for at in zip(*np.nonzero(interior), strict=True)
    ]
    np.testing.assert_allclose(found.descriptor[interior], expected, rtol=ACCURACY)
    assert np.isnan(found.descriptor[~interior]).all()
    assert np.any(ends.fate[interior] > 0)


@pytest.mark.parametrize("power", [0.25, 0.5, 1.0])
def test_an_orbit_that_stops_and_returns_has_the_integral_over_its_path(power: float) -> None:
    # Along y = 0 of case II: M over one period is twice the integral of (2(h − V))^((p − 1)/2) between the turning points.
    potential, energy = CASES["II"], 0.1
    cubic = np.roots([-1.0 / 3.0, 0.5, 0.0, -energy])
    left, right = np.sort(cubic.real)[:2]
    other = float(np.sort(cubic.real)[2])

    def smooth(x: float, power: float) -> float:
        # 2(h − V) without the factors that vanish at both turning points.
        return (2.0 / 3.0 * (other - x)) ** (0.5 * (power - 1.0))

    ends = {"weight": "alg", "wvar": (0.5 * (power - 1.0),) * 2}
    expected = 2.0 * quad(smooth, left, right, args=(power,), **ends, epsrel=1e-12)[0]
    period = 2.0 * quad(smooth, left, right, args=(0.0,), weight="alg", wvar=(-0.5, -0.5), epsrel=1e-12)[0]
    curves = exit_curves(potential, energy)[None]
    start = np.array([[left, 0.0, 0.0, 0.0]])
    found = integrate_speed(potential, curves, start, np.zeros(1), period, power)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_the_descriptor_of_both_directions_is_the_sum_of_each() -> None:
    frame = compute_map(SPECS["in a rotating frame"])
    both, *ways = (compute_lagrangian_descriptor(frame, direction=way).descriptor for way in ("both", "forward", "backward"))
    np.testing.assert_array_equal(both, ways[0] + ways[1])


def test_a_map_along_a_parameter_has_the_descriptors_of_its_potentials() -> None:
    plane = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I")))
    found = compute_lagrangian_descriptor(compute_map(MapSpec(CASES["I"], plane, 0.2, (4, 3), t_max=50.0)), power=1.0)
    row, column = 2, 1
    x, epsilon = found.spec.pixel_centres()[0][column], found.spec.pixel_centres()[1][row]
    of_row = MapSpec(CASES["I"].with_parameters(epsilon=epsilon), Plane.X_PX, 0.2, (1, 1), (x - 0.1, x + 0.1, -0.1, 0.1), 50.0)
    alone = compute_lagrangian_descriptor(compute_map(of_row), power=1.0)
    np.testing.assert_allclose(found.descriptor[row, column], alone.descriptor[0, 0], rtol=ACCURACY)


def test_long_integrals_are_cancelled_before_they_are_complete() -> None:
    cancel = Event()

    class CancelsAtSecondCall(SerialExecutor):
        calls = 0

        def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            self.calls += 1
            if self.calls > 1:
                cancel.set()
            return super().submit(fn, *args, **kwargs)

    # Until its end, the integral of one bounded orbit takes minutes.
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.1, (1, 1), t_max=20.0))
    found = compute_lagrangian_descriptor(frame, duration=1e8, execution=Execution(CancelsAtSecondCall(), cancel))
    assert not found.complete
    assert np.isnan(found.descriptor).all()


def test_starts_without_an_orbit_have_no_descriptor() -> None:
    spec = MapSpec(CASES["II"], Plane.X_Y, 0.24, (20, 20), t_max=20.0)
    frame = compute_map(spec)
    found = compute_lagrangian_descriptor(frame, duration=2.0)
    assert {Fate.FORBIDDEN, Fate.OUTSIDE} <= set(frame.fate.ravel().tolist())
    np.testing.assert_array_equal(np.isfinite(found.descriptor), frame.interior)


def test_a_map_without_starts_has_no_descriptor() -> None:
    beyond_the_wall = MapSpec(CASES["III"], Plane.X_PX, 0.3, (4, 4), window=(3.0, 3.1, 5.0, 5.1), t_max=100.0)
    found = compute_lagrangian_descriptor(compute_map(beyond_the_wall))
    assert found.complete
    assert found.describe() == "No start has a Lagrangian descriptor."
