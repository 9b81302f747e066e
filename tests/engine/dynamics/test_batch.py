from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy

import numpy as np
import pytest

from engine import CASES, Fate, Plane, start_states
from engine.dynamics.batch import OrbitBatch, OrbitPool, Tile, propagate_batch
from engine.execution import Execution, create_thread_pool, default_executor
from engine.exits.exit_rows import exit_curves

POTENTIAL, ENERGY = CASES["III"], 0.4


@pytest.fixture
def batch() -> OrbitBatch:
    x, px = np.random.default_rng(2).uniform(-0.4, 0.4, (2, 60))
    x[7] = 3.0  # forbidden: V(3, 0) > h
    return OrbitBatch.from_starts(start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px), np.zeros(60, np.int64))


@pytest.fixture
def curves() -> np.ndarray:
    return exit_curves(POTENTIAL, ENERGY)[None]


def test_initial_fates(batch: OrbitBatch) -> None:
    assert batch.fate[7] == Fate.FORBIDDEN
    assert set(np.delete(batch.fate, 7)) == {Fate.NOT_COMPUTED}


def test_only_selected_orbits_are_propagated(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch, np.arange(10, 20), 50.0, final=True)
    assert set(np.flatnonzero(batch.fate >= 0)) == set(range(10, 20))


def test_intermediate_horizon_gives_no_bounded_orbits(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=False)
    assert Fate.BOUNDED not in batch.fate
    assert np.any(batch.fate >= 1)
    assert np.all(batch.t[batch.fate == Fate.NOT_COMPUTED] > 18.0)


def test_propagation_continues_after_reopening(batch: OrbitBatch, curves: np.ndarray) -> None:
    direct = deepcopy(batch)
    propagate_batch(POTENTIAL, curves, direct, np.arange(60), 90.0, final=True)
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 30.0, final=True)
    batch.reopen(np.flatnonzero(batch.fate == Fate.BOUNDED))
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 90.0, final=True)
    np.testing.assert_array_equal(batch.fate, direct.fate)
    np.testing.assert_array_equal(batch.t, direct.t)
    np.testing.assert_array_equal(batch.crossings + batch.last_crossings, direct.crossings + direct.last_crossings)


def test_worker_errors_are_raised(batch: OrbitBatch, curves: np.ndarray) -> None:
    class Broken(ThreadPoolExecutor):
        def submit(self, *_arguments: object, **_named: object):
            return super().submit(lambda: 1 / 0)

    with Broken(1) as pool, pytest.raises(ZeroDivisionError):
        propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=True, execution=Execution(pool))


def test_default_executor_is_shared() -> None:
    assert default_executor() is default_executor()


@pytest.mark.skipif(sys.platform != "linux", reason="on other systems priorities are per process")
def test_compute_threads_have_lower_priority() -> None:
    with create_thread_pool(1) as pool:
        assert pool.submit(os.sched_getscheduler, 0).result() == os.SCHED_OTHER
        assert pool.submit(os.getpriority, os.PRIO_PROCESS, 0).result() > os.getpriority(os.PRIO_PROCESS, 0)


class CountingPool(ThreadPoolExecutor):
    calls = 0

    def submit(self, *arguments: object, **named: object):
        self.calls += 1
        return super().submit(*arguments, **named)


def test_a_worker_takes_its_share_of_the_orbits_left_in_whole_vectors() -> None:
    pool = OrbitPool(np.arange(100), 2)
    assert [pool.take().size, pool.take().size, pool.waiting] == [56, 44, 0]


def test_orbits_that_are_given_back_are_propagated_last(batch: OrbitBatch) -> None:
    pool = OrbitPool(np.arange(20), 2)
    tile = Tile.copy_from(batch, pool.take())
    tile.active[:] = 0
    tile.active[[3, 5]] = 1
    pool.give_back(tile)
    assert pool.take().tolist() == [16, 17, 18, 19, 3, 5]


@pytest.mark.parametrize("count", [10, 40, 60])
def test_orbits_that_do_not_fill_the_lanes_are_propagated_to_the_end(batch: OrbitBatch, curves: np.ndarray, count: int) -> None:
    with CountingPool(2) as pool:
        propagate_batch(POTENTIAL, curves, batch, np.arange(count), 50.0, final=True, execution=Execution(pool))
    assert pool.calls <= 2
