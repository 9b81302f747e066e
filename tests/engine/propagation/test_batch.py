"""Batches of orbits keep undecided orbits, raise errors of workers, and compute with low priority."""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest

from engine import CASES, Fate, Plane, start_states
from engine.exits.exit_rows import exit_curves
from engine.exits.interior import find_outside_channels
from engine.foundations.execution import Execution, create_thread_pool
from engine.propagation.batch import OrbitBatch
from engine.propagation.batch_propagation import propagate_batch

POTENTIAL, ENERGY = CASES["III"], 0.4


@pytest.fixture
def batch() -> OrbitBatch:
    x, px = np.random.default_rng(2).uniform(-0.4, 0.4, (2, 60))
    x[7] = 3.0  # forbidden: V(3, 0) > h
    return OrbitBatch.from_starts(start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px), np.zeros(60, np.int64))


@pytest.fixture
def curves() -> np.ndarray:
    return exit_curves(POTENTIAL, ENERGY)[None]


def test_intermediate_horizon_gives_no_bounded_orbits(batch: OrbitBatch, curves: np.ndarray) -> None:
    propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=False)
    assert Fate.BOUNDED not in batch.fate
    assert np.any(batch.fate >= 1)
    assert np.all(batch.t[batch.fate == Fate.NOT_COMPUTED] > 18.0)


def test_starts_beyond_an_exit_are_found_also_beside_forbidden_starts_of_the_same_position() -> None:
    potential, energy = CASES["II"], 0.175
    x, px = np.meshgrid(np.linspace(-1.05, 1.05, 43), np.linspace(-0.3, 0.3, 12))
    states = start_states(potential, Plane.X_PX, energy, x.ravel(), px.ravel())
    batch = OrbitBatch.from_starts(states, np.zeros(x.size, np.int64))
    batch.mark_outside(potential, np.arange(x.size), exit_curves(potential, energy)[None])
    real = np.isfinite(states).all(axis=1)
    expected = find_outside_channels(potential, energy, *states[:, :2].T)
    assert not batch.outside[~real].any()
    assert batch.outside[real].any()
    np.testing.assert_array_equal(batch.outside[real], expected[real])


def test_worker_errors_are_raised(batch: OrbitBatch, curves: np.ndarray) -> None:
    class Broken(ThreadPoolExecutor):
        def submit(self, *_arguments: object, **_named: object):
            return super().submit(lambda: 1 / 0)

    with Broken(1) as pool, pytest.raises(ZeroDivisionError):
        propagate_batch(POTENTIAL, curves, batch, np.arange(60), 20.0, final=True, execution=Execution(pool))


@pytest.mark.skipif(sys.platform != "linux", reason="on other systems priorities are per process")
def test_compute_threads_have_lower_priority() -> None:
    with create_thread_pool(1) as pool:
        assert pool.submit(os.sched_getscheduler, 0).result() == os.SCHED_OTHER
        assert pool.submit(os.getpriority, os.PRIO_PROCESS, 0).result() > os.getpriority(os.PRIO_PROCESS, 0)


@pytest.mark.skipif(sys.platform != "linux", reason="on other systems priorities are per process")
def test_compute_threads_keep_the_priority_of_a_program_that_gives_way_to_all_others() -> None:
    lowest = 19
    with ThreadPoolExecutor(1, initializer=partial(os.setpriority, os.PRIO_PROCESS, 0, lowest)) as parent:
        pool = parent.submit(create_thread_pool, 1).result()
        # A pool starts its thread in the thread of the first call.
        assert parent.submit(lambda: pool.submit(os.getpriority, os.PRIO_PROCESS, 0).result()).result() == lowest
        pool.shutdown()
