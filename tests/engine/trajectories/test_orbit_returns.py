"""Returns of given orbits agree with those of maps, of single orbits and of SciPy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, POTENTIALS, Fate, MapSpec, Plane, compute_returns, find_returns, integrate_orbit, read_section
from engine.results import OrbitReturns

CASE, ENERGY, T_MAX = CASES["III"], 0.3, 80.0
SPEC = MapSpec(CASE, Plane.X_PX, ENERGY, (9, 8), t_max=T_MAX, use_evidence=False)


def starts_of(spec: MapSpec) -> np.ndarray:
    """The states at all pixels, row by row."""
    return spec.start_states(*(grid.ravel() for grid in np.meshgrid(*spec.pixel_centres())))


def test_the_starts_of_a_map_have_its_returns() -> None:
    of_map = compute_returns(SPEC, returns=7)
    is_orbit = np.isfinite(starts_of(SPEC)).all(axis=1)
    found = find_returns(CASE, ENERGY, starts_of(SPEC)[is_orbit], 7, T_MAX)
    np.testing.assert_array_equal(found.states, of_map.states.reshape(7, -1, 4)[:, is_orbit])
    np.testing.assert_array_equal(found.time, of_map.time.reshape(7, -1)[:, is_orbit])
    np.testing.assert_array_equal(found.fate, of_map.fate.ravel()[is_orbit])
    np.testing.assert_array_equal(found.count, of_map.count.ravel()[is_orbit])


@pytest.mark.parametrize("text", ["x = 0, px > 0", "x + 0.3 py = 0.05 both", "apsis", "angle = 40°"])
def test_returns_to_a_section_are_those_of_the_single_orbit(text: str) -> None:
    states = starts_of(SPEC)[[30, 40]]
    found = find_returns(CASE, ENERGY, states, 200, T_MAX, section=text)
    for k, state in enumerate(states):
        orbit = integrate_orbit(CASE, state, T_MAX, section=read_section(text))
        points = read_section(text).axes.points(found.states[: found.count[k], k])
        np.testing.assert_allclose(points, orbit.find_section_crossings(), atol=1e-12)
        assert found.fate[k] == orbit.fate


def test_a_rotating_system_agrees_with_another_integrator() -> None:
    hill, energy = POTENTIALS["Hill"], -2.3
    (start,) = MapSpec(hill, Plane.X_PX, energy).start_states(np.array([0.25]), np.array([0.0]))
    found = find_returns(hill, energy, start[None], 3, 20.0, section="y = 0, py < 0")

    def derivative(t: float, state: np.ndarray) -> list[float]:
        x, y, px, py = state
        slope_x, slope_y = (float(each) for each in hill.gradient(x, y))
        rotation = hill.rotation
        return [px, py, 2.0 * rotation * py - slope_x, -2.0 * rotation * px - slope_y]

    event: Callable[[float, np.ndarray], float] = lambda t, state: float(state[1]) if t > 1e-3 else -1.0  # noqa: E731
    event.direction = -1.0  # type: ignore[attr-defined]
    path = solve_ivp(derivative, (0.0, float(found.time[-1, 0]) + 0.1), start, "DOP853", rtol=1e-13, atol=1e-14, events=event)
    np.testing.assert_allclose(found.time[:, 0], path.t_events[0][:3], atol=1e-8)
    np.testing.assert_allclose(found.states[:, 0], path.y_events[0][:3], atol=1e-8)


def test_an_orbit_with_all_returns_has_no_fate_yet() -> None:
    found = find_returns(CASE, 0.1, [[0.0, 0.0, 0.2**0.5, 0.0]], 2, 1e3, section="x = 0")
    assert found.count.tolist() == [2]
    assert found.fate.tolist() == [Fate.NOT_COMPUTED]


def test_illegal_requests_are_refused() -> None:
    with pytest.raises(ValueError, match="returns=0: must be"):
        find_returns(CASE, ENERGY, starts_of(SPEC)[[30]], 0)
    with pytest.raises(ValueError, match="states: row 0 has energy"):
        find_returns(CASE, 0.31, starts_of(SPEC)[[30]])


def test_no_orbit_is_followed_without_starts() -> None:
    found: OrbitReturns = find_returns(CASE, ENERGY, np.empty((0, 4)), 3)
    assert found.states.shape == (3, 0, 4)
