"""A map is the same however it was computed: at once, continued from shorter ones, interrupted, on any number of threads."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import (
    CASES,
    Coordinate,
    EscapeMap,
    Evidence,
    MapSpec,
    ParameterAxis,
    Plane,
    Slice,
    System,
    compute_map,
)
from engine.foundations.execution import SerialExecutor
from engine.maps.result import PIXEL_ARRAYS
from tests.forgetful_pool import ForgetfulPool

ALONG_EPSILON = Slice(Coordinate.X, ParameterAxis("epsilon", 0.9, 1.1, System("I")))
# The orbits of each map are tested at t = 1000 and 10 000, and those of the last map also at 100 000.
SPECS = {
    "III": MapSpec(CASES["III"], Plane.X_PX, 0.30, (24, 24), t_max=2e4),
    "many energies": MapSpec(CASES["III"], Plane.X_H, (0.25, 0.5), (16, 12), t_max=2e4),
    "a parameter": MapSpec(CASES["I"], ALONG_EPSILON, 0.13, (24, 4), t_max=2e4),
    "III, longer": MapSpec(CASES["III"], Plane.X_PX, 0.35, (40, 40), t_max=1.1e5),
}
# Times of shorter maps: those at which orbits are tested, just before and just after them, and between them.
LADDER = (500.0, 999.9, 1e3, 1000.1, 1e4, 1.5e4, 19999.0)
each_spec = pytest.mark.parametrize("spec", SPECS.values(), ids=SPECS)


@cache
def at_once(spec: MapSpec) -> EscapeMap:
    return compute_map(spec)


def assert_same_map(one: EscapeMap, other: EscapeMap) -> None:
    assert one.complete
    assert other.complete
    for name in PIXEL_ARRAYS:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def early(escape_map: EscapeMap) -> np.ndarray:
    """Return which pixels are called bounded before t_max, of shape (rows, columns)."""
    return ~np.isin(escape_map.evidence, (Evidence.NONE, Evidence.INTEGRATED))


class CallCounter(SerialExecutor):
    """Runs calls, and counts them."""

    calls = 0

    def submit(self, *args, **kwargs):  # type: ignore[no-untyped-def]
        """Count and make the call."""
        self.calls += 1
        return super().submit(*args, **kwargs)


@each_spec
def test_a_map_continued_from_shorter_maps_equals_a_map_computed_at_once(spec: MapSpec) -> None:
    result = None
    for t_max in (*LADDER, spec.t_max):
        result = compute_map(replace(spec, t_max=t_max), resume=result)
    assert result is not None
    assert_same_map(result, at_once(spec))


@each_spec
def test_evidence_does_not_depend_on_the_number_of_threads(spec: MapSpec) -> None:
    with ThreadPoolExecutor(3) as pool:
        assert_same_map(compute_map(spec, executor=pool), at_once(spec))


@pytest.mark.parametrize("name", ["many energies", "a parameter"])
def test_a_map_interrupted_at_any_call_is_resumed_to_the_same_result(name: str) -> None:
    spec, counter = SPECS[name], CallCounter()
    assert_same_map(compute_map(spec, executor=counter), at_once(spec))
    for good_calls in range(0, counter.calls, max(1, counter.calls // 6)):
        cancel = threading.Event()
        with ForgetfulPool(good_calls, cancel) as pool:
            interrupted = compute_map(spec, cancel=cancel, executor=pool)
        assert_same_map(compute_map(spec, resume=interrupted), at_once(spec))


def test_an_interrupted_test_for_evidence_leaves_no_evidence() -> None:
    spec, counter = SPECS["III"], CallCounter()
    after_each_test = [early(compute_map(replace(spec, t_max=t_max))) for t_max in (1e3, 1e4)] + [early(at_once(spec))]
    compute_map(spec, executor=counter)
    for good_calls in range(0, counter.calls, 4):
        cancel = threading.Event()
        with ForgetfulPool(good_calls, cancel) as pool:
            interrupted = compute_map(spec, cancel=cancel, executor=pool)
        assert any(np.array_equal(early(interrupted), expected) for expected in after_each_test), good_calls
