"""Each line of a map along a parameter is the map of one potential."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    Coordinate,
    EscapeMap,
    Fate,
    MapSpec,
    ParameterAxis,
    Slice,
    System,
    Trust,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_trust,
)
from engine.maps.parameter_map import find_lines
from tests.engine.slices.test_parameter_family import THIRD_EXIT

C = Coordinate
EPSILON = ParameterAxis("epsilon", 0.5, 2.0, System("I"))
SPEC = MapSpec(CASES["I"], Slice(C.X, EPSILON), 0.2, (24, 12), t_max=2e3)
FREQUENCY = ParameterAxis("omega_1", 0.4, 1.5, System("III"))
TURNED = MapSpec(CASES["III"], Slice(FREQUENCY, C.PX, fixed=((C.X, 0.1),)), 0.5, (7, 16), t_max=1e3)


@pytest.fixture(scope="module")
def along_epsilon() -> EscapeMap:
    return compute_map(SPEC)


def ordinary_map(spec: MapSpec, axis: ParameterAxis, value: float) -> EscapeMap:
    """Return the map of the potential with one value of the parameter, computed without a parameter as an axis."""
    potential = axis.system.with_parameter(axis.key, value).potential
    window = spec.find_window()
    if spec.plane.parameter_axis == 1:
        part = (window.x_low, window.x_high, -1.0, 1.0)
        return compute_map(MapSpec(potential, Slice(spec.plane.abscissa, C.PX), spec.energy, (24, 1), part, spec.t_max))
    part = (0.1 - 1.0, 0.1 + 1.0, window.ordinate_low, window.ordinate_high)
    return compute_map(MapSpec(potential, Slice(C.X, spec.plane.ordinate), spec.energy, (1, 16), part, spec.t_max))


def assert_equal_outcomes(one: EscapeMap, other: EscapeMap) -> None:
    np.testing.assert_array_equal(one.fate, other.fate)
    np.testing.assert_array_equal(one.crossings[one.fate > 0], other.crossings[one.fate > 0])
    np.testing.assert_allclose(one.escape_time, other.escape_time, rtol=1e-6)


def test_rows_are_maps_of_their_potentials(along_epsilon: EscapeMap) -> None:
    for line in find_lines(SPEC):
        assert line is not None
        row = line.place[0].start
        expected = ordinary_map(SPEC, EPSILON, float(along_epsilon.ordinate[row]))
        assert_equal_outcomes(line.extract(along_epsilon), expected)


def test_columns_are_maps_of_their_potentials() -> None:
    found = compute_map(TURNED)
    for column, line in enumerate(find_lines(TURNED)):
        assert line is not None
        # Lines with different units of time, because the frequency changes by more than a factor of 2.
        assert_equal_outcomes(line.extract(found), ordinary_map(TURNED, FREQUENCY, float(found.x[column])))


def test_channels_keep_their_numbers_along_the_parameter() -> None:
    spec = MapSpec(THIRD_EXIT.system.potential, Slice(C.X, THIRD_EXIT), 0.16, (16, 8), t_max=500.0)
    found = compute_map(spec)
    assert set(found.fractions()) == {1, 2, 3, Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED}
    # The exit at the left is open for b < −0.34; y → −y exchanges the other two.
    left = found.ordinate < -0.35
    assert np.any(found.fate[left] == 3)
    assert set(np.unique(found.fate[~left & (found.ordinate > -0.33)])) - {Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE} == {1, 2}


class CountingExecutor(ThreadPoolExecutor):
    """An executor of one thread, whose third call waits until the last call that was submitted is cancelled."""

    def __init__(self) -> None:
        super().__init__(1)
        self.begun = 0
        self._last: Future[Any] | None = None
        self._is_dropped = threading.Event()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        call = self._last = super().submit(self._run, fn, *args, **kwargs)
        call.add_done_callback(self._note_drop)
        return call

    def _run(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        self.begun += 1
        if self.begun == 3:
            self._is_dropped.wait(timeout=10.0)
        return fn(*args, **kwargs)

    def _note_drop(self, call: Future[Any]) -> None:
        if call is self._last and call.cancelled():
            self._is_dropped.set()


def test_lines_that_wait_in_an_executor_are_dropped_when_a_map_is_cancelled() -> None:
    cancel = threading.Event()
    # The first stage computes every eighth line. The map is cancelled after the first one, and notices it after the second one.
    spec = replace(SPEC, resolution=(24, 400))
    with CountingExecutor() as executor:
        stopped = compute_map(spec, cancel=cancel, executor=executor, on_progress=lambda share: cancel.set())
    assert not stopped.complete
    assert executor.begun == 3


def test_trust_and_character_are_those_of_the_lines(along_epsilon: EscapeMap) -> None:
    trust, character = compute_trust(along_epsilon), compute_regularity(along_epsilon)
    assert trust.complete
    assert character.complete
    for line in find_lines(SPEC):
        assert line is not None
        np.testing.assert_array_equal(character.character[line.place], compute_regularity(line.extract(along_epsilon)).character)
        alone = compute_trust(line.extract(along_epsilon)).trust
        tested = alone != Trust.LIKE_NEIGHBOURS
        # In the map, more pixels are tested, because neighbours in other lines have other outcomes.
        np.testing.assert_array_equal(trust.trust[line.place][tested], alone[tested])


def test_origins_along_a_parameter_are_those_of_the_lines() -> None:
    spec = replace(SPEC, resolution=(16, 4), t_max=200.0)
    origins = compute_origin_fates(spec)
    np.testing.assert_array_equal(origins.origin, compute_map(replace(spec, backward=True)).fate)


def test_a_value_without_a_system_has_forbidden_starts() -> None:
    spec = replace(SPEC, window=(-0.5, 0.5, -0.5, 1.5), resolution=(8, 8), t_max=100.0)
    found = compute_map(spec)
    assert found.complete
    assert np.all(found.fate[found.ordinate < 0.01] == Fate.FORBIDDEN)
    assert np.any(found.fate[found.ordinate > 0.01] > Fate.FORBIDDEN)
