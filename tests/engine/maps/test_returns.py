"""Returns to the surface of section agree with the crossings of maps and of single orbits, in every system."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    EscapeMap,
    Execution,
    Fate,
    MapSpec,
    Plane,
    System,
    compute_map,
    compute_returns,
    integrate_orbit,
    open_result,
)
from engine.results import Returns
from engine.slices.axes import ParameterAxis
from engine.slices.slice_text import read_slice
from engine.systems.review.potential_review import review_system

SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.24, (12, 11), t_max=60.0, use_evidence=False)
SYSTEMS = {
    "below every saddle": SPEC,
    "four exits": MapSpec(CASES["III"], Plane.X_Y, 0.3, (10, 12), t_max=60.0, use_evidence=False),
    **{
        name: MapSpec(
            POTENTIALS[name],
            Plane.X_PX,
            review_system(System(name)).energies.first,
            (10, 8),
            t_max=40.0 * POTENTIALS[name].units.time,
            use_evidence=False,
        )
        for name in ("Copenhagen", "Hill", "Star cluster", "Four hills")
    },
    "backward": replace(SPEC, backward=True),
    "several energies": MapSpec(CASES["I"], Plane.X_H, (0.1, 0.3), (9, 8), t_max=40.0, use_evidence=False),
}


@pytest.fixture(scope="module", params=SYSTEMS)
def pair(request: pytest.FixtureRequest) -> tuple[EscapeMap, Returns]:
    spec = SYSTEMS[request.param]
    return compute_map(spec), compute_returns(spec, returns=200)


def test_orbits_return_as_often_as_they_cross_in_the_map(pair: tuple[EscapeMap, Returns]) -> None:
    escape_map, found = pair
    assert found.complete
    assert found.count.max() > 1
    np.testing.assert_array_equal(found.count, np.where(escape_map.fate >= 0, escape_map.crossings, 0))


def test_orbits_that_end_before_their_last_return_have_the_fate_of_the_map(pair: tuple[EscapeMap, Returns]) -> None:
    escape_map, found = pair
    np.testing.assert_array_equal(found.fate, escape_map.fate)
    few = compute_returns(escape_map.spec, returns=2)
    ends = few.count < 2
    np.testing.assert_array_equal(few.fate[ends], escape_map.fate[ends])
    assert np.all(few.fate[~ends] == Fate.NOT_COMPUTED)


def test_returns_have_the_energy_of_the_start_and_ascending_times(pair: tuple[EscapeMap, Returns]) -> None:
    escape_map, found = pair
    spec = escape_map.spec
    x, ordinate = np.meshgrid(escape_map.x, escape_map.ordinate)
    energies = spec.energies(x.ravel(), ordinate.ravel()).reshape(x.shape)
    difference = np.abs(spec.potential.energy(found.states.reshape(-1, 4)).reshape(found.time.shape) - energies)
    assert np.nanmax(difference) < 1e-10 * spec.potential.units.energy
    is_found = np.isfinite(found.time)
    assert np.all(np.diff(found.time, axis=0)[is_found[1:]] > 0.0)
    assert np.all(found.time[is_found] <= spec.t_max)
    end = np.broadcast_to(np.where(escape_map.fate > 0, escape_map.escape_time, spec.t_max), found.time.shape)
    assert np.all(found.time[is_found] <= end[is_found])


def test_returns_agree_with_another_integrator() -> None:
    found = compute_returns(SPEC, returns=3)
    row, column = np.argwhere(found.count == 3)[4]
    x, ordinate = SPEC.pixel_centres()
    start = SPEC.start_states(x[[column]], ordinate[[row]])[0]

    def derivative(t: float, state: np.ndarray) -> list[float]:
        slope_x, slope_y = SPEC.potential.gradient(state[0], state[1])
        return [state[2], state[3], -slope_x, -slope_y]

    def section(t: float, state: np.ndarray) -> float:
        return float(state[1]) if t > 1e-3 else 1.0

    section.direction = 1.0  # type: ignore[attr-defined]
    path = solve_ivp(derivative, (0.0, 60.0), start, "DOP853", rtol=1e-13, atol=1e-14, events=section)
    np.testing.assert_allclose(found.states[:, row, column], path.y_events[0][:3], atol=1e-9)
    np.testing.assert_allclose(found.time[:, row, column], path.t_events[0][:3], atol=1e-9)


def test_returns_are_those_of_single_orbits() -> None:
    found = compute_returns(SPEC, returns=200)
    row, column = np.argwhere(found.count == found.count.max())[0]
    x, ordinate = SPEC.pixel_centres()
    start = SPEC.start_states(x[[column]], ordinate[[row]])[0]
    crossings = integrate_orbit(SPEC.potential, start, SPEC.t_max).find_section_crossings()
    (points,) = (each for each in found.points() if np.allclose(each[0], found.states[0, row, column, [0, 2]], rtol=0, atol=0))
    np.testing.assert_allclose(points, crossings, atol=1e-13)


def test_returns_do_not_depend_on_the_number_of_threads_or_of_returns() -> None:
    found = compute_returns(SPEC, returns=5)
    with ThreadPoolExecutor(3) as pool:
        again = compute_returns(SPEC, returns=9, execution=Execution(pool))
    assert found.states.tobytes() == again.states[:5].tobytes()
    assert found.time.tobytes() == again.time[:5].tobytes()


def test_frames_arrive_while_orbits_are_followed() -> None:
    frames: list[Returns] = []
    found = compute_returns(SPEC, returns=2, on_frame=frames.append)
    assert not frames[0].complete
    assert "so far" in frames[0].describe()
    assert frames[-1].time.tobytes() == found.time.tobytes()


def test_a_cancelled_computation_is_not_complete() -> None:
    class CancellingPool(ThreadPoolExecutor):
        """Cancels all calls."""

        def submit(self, *arguments: Any, **named: Any) -> Future[Any]:
            future = Future[Any]()
            future.cancel()
            return future

    cancel = threading.Event()
    cancel.set()
    for execution in (Execution(cancel=cancel), Execution(CancellingPool(), cancel=cancel)):
        found = compute_returns(SPEC, returns=2, execution=execution)
        assert not found.complete
        assert not np.isfinite(found.time).any()


def test_a_file_holds_the_returns_and_their_request(tmp_path: Path) -> None:
    found = compute_returns(SPEC, returns=3)
    found.save(tmp_path / "returns.nc")
    opened = open_result(tmp_path / "returns.nc", Returns)
    assert opened.spec == SPEC
    np.testing.assert_array_equal(opened.states, found.states)
    np.testing.assert_array_equal(opened.time, found.time)
    assert found.to_pandas()["return_time"].count() == found.count.sum()


def test_the_table_has_a_row_for_each_return_in_the_order_of_the_orbits() -> None:
    found = compute_returns(SPEC, returns=3)
    table = found.columns()
    assert table["time"].size == found.count.sum()
    order = list(zip(table["row"], table["column"], table["return"], strict=True))
    assert order == sorted(order)
    assert np.array_equal(table["px"], found.states[table["return"] - 1, table["row"], table["column"], 2])


def parameter_map() -> MapSpec:
    system = System("I")
    plane = read_slice("x,epsilon=0.5:2", "", system)
    assert isinstance(plane.parameter, ParameterAxis)
    return MapSpec(system.potential, plane, 0.2, (5, 5))


@pytest.mark.parametrize(
    ("request_of", "message"),
    [
        (lambda: compute_returns(SPEC, returns=0), "returns=0: must be an integer from 1 to "),
        (lambda: compute_returns(replace(SPEC, resolution=(1000, 1000)), returns=6), "must be an integer from 1 to 5"),
        (lambda: compute_returns(parameter_map()), "has a parameter as axis"),
    ],
)
def test_a_request_out_of_range_is_refused(request_of: Callable[[], Returns], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        request_of()
