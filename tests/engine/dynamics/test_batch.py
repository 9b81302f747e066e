from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from engine import CASES, Fate, Plane, start_states
from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.lyapunov_orbits import exit_curves
from engine.execution import default_executor, thread_pool

POTENTIAL, ENERGY = CASES["III"], 0.4


@pytest.fixture
def batch() -> OrbitBatch:
    x, px = np.random.default_rng(2).uniform(-0.4, 0.4, (2, 60))
    x[7] = 3.0  # V ≤ h there would need y; on y = 0 the start is forbidden
    return OrbitBatch.from_starts(start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px), np.zeros(60, np.int64))


@pytest.fixture
def curves() -> np.ndarray:
    return exit_curves(POTENTIAL, ENERGY)[None]


def test_a_start_that_does_not_exist_is_forbidden_and_the_others_are_open(batch: OrbitBatch) -> None:
    assert batch.fate[7] == Fate.FORBIDDEN
    assert set(np.delete(batch.fate, 7)) == {Fate.NOT_COMPUTED}


def test_only_orbits_asked_for_are_carried_on(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch, np.arange(10, 20), 50.0, final=True)
    assert set(np.flatnonzero(batch.fate >= 0)) == set(range(10, 20))


def test_an_intermediate_horizon_settles_escapes_only(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=False)
    assert Fate.BOUNDED not in batch.fate
    assert np.any(batch.fate >= 1)
    assert np.all(batch.t[batch.fate == Fate.NOT_COMPUTED] > 18.0)


def test_reopened_orbits_can_go_on(batch: OrbitBatch, curves: np.ndarray) -> None:
    straight = batch.copy()
    propagate_batch(POTENTIAL, curves, straight, np.arange(60), 90.0, final=True)
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 30.0, final=True)
    batch.reopen_bounded()
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 90.0, final=True)
    np.testing.assert_array_equal(batch.fate, straight.fate)
    np.testing.assert_array_equal(batch.t, straight.t)
    np.testing.assert_array_equal(batch.crossings + batch.last_crossings, straight.crossings + straight.last_crossings)


def test_a_copy_goes_its_own_way(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch.copy(), np.arange(60), 20.0, final=True)
    assert not batch.t.any()


def test_an_error_in_a_worker_reaches_the_caller(batch: OrbitBatch, curves: np.ndarray) -> None:
    class Broken(ThreadPoolExecutor):
        def submit(self, *_arguments: object, **_named: object):
            return super().submit(lambda: 1 / 0)

    with Broken(1) as pool, pytest.raises(ZeroDivisionError):
        propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=True, executor=pool)


def test_there_is_one_pool_in_the_process() -> None:
    assert default_executor() is default_executor()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere priorities belong to whole processes")
def test_threads_can_take_what_the_processors_have_left() -> None:
    with thread_pool(1) as usual, thread_pool(1, only_idle=True) as modest:
        assert usual.submit(os.sched_getscheduler, 0).result() == os.SCHED_OTHER
        assert modest.submit(os.sched_getscheduler, 0).result() == os.SCHED_IDLE
